#include "wiimote_tracker_triangulation/motion/motion_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wiimote_tracker::motion {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// What moves may stop at every image, but no more finely than this [s]. Any less would cost
/// accuracy where an LED stops: what is still is then where it last was followed.
constexpr double kStopInterval = 0.002;

/// All other changes between ways to move [s]: in so short a time they take an LED nowhere.
constexpr double kChangeInterval = 0.01;

/// Probability of a change within a duration, at a rate.
double probabilityOf(double rate, double duration) {
  return rate * duration / (1.0 + rate * duration);
}

double square(double x) {
  return x * x;
}

/// Sudden, the last, may be left out.
int waysToMove(const MotionOptions& options) {
  return options.sudden_random_walk > 0.0 ? 4 : 3;
}

/// Variance of the acceleration with which each way to move is taken up [m^2/s^4].
Lanes accelerationVariances(const MotionOptions& options) {
  return {square(options.smooth.stddev), square(options.gentle.stddev),
          square(options.brisk.stddev), 0.0};
}

template <typename Numbers>
Vector3 meanOf(const Numbers& weights, const std::array<Numbers, 3>& means) {
  Vector3 mean;
  for (int i = 0; i < 3; ++i)
    mean[i] = (weights * means[i]).sum();
  return mean;
}

/// Second moments of a mixture of normal distributions about a place. It is that of the weights
/// given, whose sum need not be 1.
template <typename Numbers>
Matrix3 spreadAbout(const Vector3& place,
                    const Numbers& weights,
                    const std::array<Numbers, 3>& means,
                    const std::array<Numbers, 6>& covariances) {
  std::array<Numbers, 3> d;
  for (int i = 0; i < 3; ++i)
    d[i] = means[i] - place[i];
  Matrix3 result;
  for (int i = 0, k = 0; i < 3; ++i) {
    const Numbers weighted = weights * d[i];
    for (int j = i; j < 3; ++j, ++k)
      result(i, j) = result(j, i) = (weights * covariances[k] + weighted * d[j]).sum();
  }
  return result;
}

/// Covariance of a pixel's noise [px^2].
struct ImageNoise {
  double uu, uv, vv;
  double least;  // variance in any direction
};

/// The images of states whose positions and covariances are given. Returns the largest of their
/// squared distances from the mean's image, each with its variances [px^2].
template <typename Numbers>
double project(const Matrix23& H,
               const Vector3& mean,
               const std::array<Numbers, 3>& p,
               const std::array<Numbers, 6>& pp,
               const ImageNoise& noise,
               StateImages<Numbers>* images) {
  constexpr int kRows[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Numbers offset_u = Numbers::Zero(), offset_v = Numbers::Zero();
  std::array<Numbers, 3> gain_u, gain_v;
  for (int i = 0; i < 3; ++i) {
    const Numbers d = p[i] - mean[i];
    offset_u += H(0, i) * d;
    offset_v += H(1, i) * d;
    gain_u[i] = H(0, 0) * pp[kRows[i][0]] + H(0, 1) * pp[kRows[i][1]] + H(0, 2) * pp[kRows[i][2]];
    gain_v[i] = H(1, 0) * pp[kRows[i][0]] + H(1, 1) * pp[kRows[i][1]] + H(1, 2) * pp[kRows[i][2]];
  }
  const Numbers uu = H(0, 0) * gain_u[0] + H(0, 1) * gain_u[1] + H(0, 2) * gain_u[2] + noise.uu;
  const Numbers uv = H(0, 0) * gain_v[0] + H(0, 1) * gain_v[1] + H(0, 2) * gain_v[2] + noise.uv;
  const Numbers vv = H(1, 0) * gain_v[0] + H(1, 1) * gain_v[1] + H(1, 2) * gain_v[2] + noise.vv;
  images->u = offset_u;
  images->v = offset_v;
  // Neither pivot is less than the noise; but that of a vast covariance is a difference of large
  // numbers, of which rounding may leave less than nothing.
  images->whiten_uu = 1.0 / uu.max(noise.least).sqrt();
  const Numbers l_vu = uv * images->whiten_uu;
  images->whiten_vv = 1.0 / (vv - l_vu * l_vu).max(noise.least).sqrt();
  images->whiten_vu = -l_vu * images->whiten_uu * images->whiten_vv;
  return (offset_u.square() + offset_v.square() + uu + vv).maxCoeff();
}

/// Of a pixel. @param from_mean from the mean's image [px]
template <typename Numbers>
Innovations<Numbers> innovationsOf(const Vector2& from_mean,
                                   const Matrix23& jacobian,
                                   const StateImages<Numbers>& images) {
  Innovations<Numbers> result;
  result.jacobian = jacobian;
  result.whiten_uu = images.whiten_uu;
  result.whiten_vu = images.whiten_vu;
  result.whiten_vv = images.whiten_vv;
  const Numbers u = from_mean.x() - images.u;
  result.u = images.whiten_uu * u;
  result.v = images.whiten_vu * u + images.whiten_vv * (from_mean.y() - images.v);
  return result;
}

/// The least distance of a way that has a probability.
template <typename Numbers>
double leastOf(const Numbers& squared_distances, const Numbers& weights) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  return (weights > 0.0).select(squared_distances, kNone).minCoeff();
}

/// Densities over exp(-least / 2), times 2 pi. No more than 1 for what has no probability.
template <typename Numbers>
Numbers relativeLikelihoods(double least,
                            const Numbers& squared_distances,
                            const Innovations<Numbers>& innovations) {
  return innovations.whiten_uu * innovations.whiten_vv *
         (0.5 * (least - squared_distances)).min(0.0).exp();
}

/// What all but vanishes is none: a product of probability and likelihood then is a number above 0
/// for at least one way, whatever was seen.
template <typename Numbers>
void scaleProbabilities(double scale, Numbers* weights) {
  constexpr double kVanishing = 1e-100;
  *weights *= scale;
  *weights = (*weights > kVanishing).select(*weights, 0.0);
}

}  // namespace

MotionFilter::MotionFilter(const MotionOptions& options,
                           double time,
                           const Vector3& position,
                           const Matrix3& covariance)
    : options_(&options), time_(time), stopped_until_(time), changed_until_(time) {
  const int ways = waysToMove(options);
  const double still = options.stop_rate > 0.0 ? 1.0 / (ways + 1) : 0.0;
  resting_weights_.setConstant(0.5 * still);
  moving_weights_.setZero();
  moving_weights_.head(ways).setConstant((1.0 - still) / ways);
  resting_.set(position, covariance);
  moving_.setZero();
  const Lanes variances = accelerationVariances(options);
  for (int i = 0, k = 0; i < 3; ++i) {
    moving_.p[i].setConstant(position[i]);
    for (int j = i; j < 3; ++j, ++k) {
      moving_.pp[k].setConstant(covariance(i, j));
      if (i == j) {
        moving_.vv[k].setConstant(square(options.initial_speed));
        moving_.aa[k] = variances;
      }
    }
  }
}

void MotionFilter::predict(double time) {
  MotionSteps steps(*options_);
  predict(time, &steps);
}

void MotionFilter::predict(double time, MotionSteps* steps) {
  if (!(time > time_) || !std::isfinite(time))
    return;
  const double duration = time - time_;
  moving_.predict(steps->over(duration));
  resting_.predict(duration * Pair(square(options_->fixed.drift), square(options_->swaying.drift)));
  time_ = time;
  if (time - stopped_until_ >= kStopInterval) {
    stop(time - stopped_until_);
    stopped_until_ = time;
  }
  if (time - changed_until_ >= kChangeInterval) {
    change(time - changed_until_);
    changed_until_ = time;
  }
}

/// The part of the interaction (see change) that leads to rest.
void MotionFilter::stop(double duration) {
  const Lanes stops = moving_weights_ * probabilityOf(options_->stop_rate, duration);
  const double all = stops.sum();
  if (!(all > 0.0))
    return;
  const Lanes shares = stops / all;
  const Vector3 place = meanOf(shares, moving_.p);
  resting_weights_ += 0.5 * all;
  resting_.join(0.5 * all / resting_weights_, place,
                spreadAbout(place, shares, moving_.p, moving_.pp));
  moving_weights_ -= stops;
}

/// The interaction: each way to move goes on from the mixture of those that may have led to it.
void MotionFilter::change(double duration) {
  const Pair starts =
      resting_weights_ * Pair(probabilityOf(options_->fixed.start_rate, duration),
                              probabilityOf(options_->swaying.start_rate, duration));
  const double start = starts.sum();
  const Pair start_shares = start > 0.0 ? Pair(starts / start) : Pair(1.0, 0.0);
  const Vector3 start_place = meanOf(start_shares, resting_.p);
  const int ways = waysToMove(*options_);
  // Joint probabilities of the way before (first index) and the way after.
  std::array<Lanes, kMoving> joint;
  Lanes taken_up = Lanes::Zero();  // by what is still or was less rash
  taken_up.head(ways).setConstant(start / ways);
  Lanes weights = taken_up;
  const Lanes started = taken_up;
  for (int i = 0; i < kMoving; ++i) {
    joint[i].setZero();
    if (i >= ways)
      continue;
    const int rasher = ways - 1 - i;
    const double rise = rasher > 0 ? options_->rise_rate : 0.0;
    const double settle = i > 0 ? options_->settle_rate : 0.0;
    const double per_rate =  // probability for each 1/s
        moving_weights_[i] * duration / (1.0 + (rise + settle) * duration);
    for (int j = 0; j < ways; ++j) {
      joint[i][j] = j < i ? per_rate * settle / i : per_rate * rise / rasher;
      if (j > i)
        taken_up[j] += joint[i][j];
    }
    joint[i][i] = moving_weights_[i] - per_rate * (rise + settle);
    weights += joint[i];
  }
  Lanes inverse;
  for (int i = 0; i < kMoving; ++i)
    inverse[i] = weights[i] > 0.0 ? 1.0 / weights[i] : 0.0;
  for (Lanes& shares : joint)
    shares *= inverse;
  moving_.mix(joint, started * inverse, start_place,
              spreadAbout(start_place, start_shares, resting_.p, resting_.pp));

  // What takes up another way does so with an acceleration of that way.
  const Lanes added = taken_up * inverse * accelerationVariances(*options_);
  for (const int diagonal : {0, 3, 5})
    moving_.aa[diagonal] += added;
  resting_weights_ -= starts;
  moving_weights_ = weights;
}

std::optional<PixelPrediction> MotionFilter::predictPixel(const geometry::Camera& camera,
                                                          const PixelNoise& noise) const {
  PixelPrediction prediction;
  prediction.smear_ = noise.stamp_stddev * velocity();
  prediction.pixel_variance_ = square(noise.pixel_stddev);
  if (!linearize(camera, position(), &prediction))
    return std::nullopt;
  return prediction;
}

/// The image of positions near `point`, which need not be the mean. False when it has none.
bool MotionFilter::linearize(const geometry::Camera& camera,
                             const Vector3& point,
                             PixelPrediction* prediction) const {
  PixelPrediction& to = *prediction;
  const std::optional<Vector2> pixel = camera.project(point, &to.jacobian_);
  if (!pixel)
    return false;
  const Matrix23& H = to.jacobian_;
  const Vector3 mean = position();
  to.pixel_ = *pixel + H * (mean - point);
  const Vector2 smear = H * to.smear_;
  const ImageNoise noise{square(smear.x()) + to.pixel_variance_, smear.x() * smear.y(),
                         square(smear.y()) + to.pixel_variance_, to.pixel_variance_};
  to.resting_.weights = resting_weights_;
  to.moving_.weights = moving_weights_;
  const double resting_reach = project(H, mean, resting_.p, resting_.pp, noise, &to.resting_);
  const double moving_reach = project(H, mean, moving_.p, moving_.pp, noise, &to.moving_);
  // (|offset| + sqrt(gate * largest variance))^2 is less, for gates of 1 and more.
  to.squared_reach_ = 2.0 * std::max(resting_reach, moving_reach);
  return true;
}

/// Whether the image of where the LED may be is flat to a small part of the pixel noise: a
/// displacement d changes the derivatives by about d / depth of themselves.
bool MotionFilter::isLinear(const geometry::Camera& camera,
                            const PixelPrediction& prediction,
                            const Vector2& pixel) const {
  constexpr double kNegligible = 0.05;  // of the noise's standard deviation
  const double depth =
      camera.world_from_camera.linear().col(2).dot(moving_.position(0) - camera.center());
  const Lanes variances = moving_.pp[0] + moving_.pp[3] + moving_.pp[5];
  const Pair resting_variances = resting_.pp[0] + resting_.pp[3] + resting_.pp[5];
  const double variance = std::max(resting_variances.maxCoeff(), variances.maxCoeff());
  return variance * (pixel - prediction.pixel_).squaredNorm() <
         square(kNegligible * depth) * prediction.pixel_variance_;
}

/// Of an LED that is seen from one side only, velocity and acceleration along the ray are
/// forgotten: what goes on evenly across the image need not do so in depth. How fast it goes there
/// is guessed from how fast it goes across.
void MotionFilter::forgetUnseen(const geometry::Camera& camera) {
  constexpr double kSquaredSine = 0.01;  // of the angle between two sides
  constexpr double kRemembered = 0.05;   // [s]
  constexpr double kForgetting = 1.0;    // to 1/e [s]
  constexpr double kSpeedShare = 0.1;    // of the mean square of a velocity across the ray
  const Vector3 view = position() - camera.center();
  const double duration = time_ - updated_;
  updated_ = time_;
  if (square(view.dot(view_)) <= (1.0 - kSquaredSine) * view.squaredNorm() * view_.squaredNorm()) {
    view_ = view;
    sides_seen_ = time_;
    return;
  }
  if (!(time_ - sides_seen_ > kRemembered))
    return;
  const Vector3 ray = view.normalized();
  const Vector3 v = velocity();
  const Matrix3 squares = velocityCovariance() + v * v.transpose();
  const double across = 0.5 * (squares.trace() - ray.dot(squares * ray));
  moving_.forget(ray, std::exp(-duration / kForgetting), kSpeedShare * across,
                 accelerationVariances(*options_));
}

bool MotionFilter::update(const geometry::Camera& camera,
                          const PixelPrediction& prediction,
                          const Vector2& pixel) {
  constexpr int kIterations = 3;
  constexpr double kAbsurd = 1e9;  // [px]
  if (!((pixel - prediction.pixel_).squaredNorm() < kAbsurd * kAbsurd))
    return false;
  if (isLinear(camera, prediction, pixel)) {
    apply(prediction, pixel);
    forgetUnseen(camera);
    return true;
  }
  // Iterated: linearised anew where the spot itself says that the LED is.
  const MotionFilter before = *this;
  apply(prediction, pixel);
  PixelPrediction closer = prediction;
  for (int i = 0; i < kIterations; ++i) {
    if (!before.linearize(camera, position(), &closer))
      break;
    *this = before;
    apply(closer, pixel);
  }
  forgetUnseen(camera);
  return true;
}

void MotionFilter::apply(const PixelPrediction& prediction, const Vector2& pixel) {
  const Vector2 from_mean = pixel - prediction.pixel_;
  const auto resting = innovationsOf(from_mean, prediction.jacobian_, prediction.resting_);
  const auto moving = innovationsOf(from_mean, prediction.jacobian_, prediction.moving_);
  resting_.update(resting);
  moving_.update(moving);

  // Probabilities by Bayes; all likelihoods over the greatest exponential, lest all become 0.
  const Pair resting_squared = resting.u.square() + resting.v.square();
  const Lanes moving_squared = moving.u.square() + moving.v.square();
  const double least = std::min(leastOf(resting_squared, resting_weights_),
                                leastOf(moving_squared, moving_weights_));
  resting_weights_ *= relativeLikelihoods(least, resting_squared, resting);
  moving_weights_ *= relativeLikelihoods(least, moving_squared, moving);
  const double scale = 1.0 / (resting_weights_.sum() + moving_weights_.sum());
  scaleProbabilities(scale, &resting_weights_);
  scaleProbabilities(scale, &moving_weights_);
}

Vector3 MotionFilter::position() const {
  return meanOf(resting_weights_, resting_.p) + meanOf(moving_weights_, moving_.p);
}

Matrix3 MotionFilter::positionCovariance() const {
  const Vector3 mean = position();
  return spreadAbout(mean, resting_weights_, resting_.p, resting_.pp) +
         spreadAbout(mean, moving_weights_, moving_.p, moving_.pp);
}

Vector3 MotionFilter::velocity() const {
  return meanOf(moving_weights_, moving_.v);
}

Matrix3 MotionFilter::velocityCovariance() const {
  const Vector3 mean = velocity();
  return stillProbability() * mean * mean.transpose() +
         spreadAbout(mean, moving_weights_, moving_.v, moving_.vv);
}

}  // namespace wiimote_tracker::motion
