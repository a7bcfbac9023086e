#include "wiimote_tracker_triangulation/motion/motion_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wiimote_tracker::motion {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

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

/// Of a mixture of four normal distributions, about its mean.
Matrix3 covarianceAbout(const Vector3& mean,
                        const Lanes& weights,
                        const std::array<Lanes, 3>& means,
                        const std::array<Lanes, 6>& covariances) {
  std::array<Lanes, 3> d;
  for (int i = 0; i < 3; ++i)
    d[i] = means[i] - mean[i];
  Matrix3 result;
  for (int i = 0, k = 0; i < 3; ++i) {
    const Lanes weighted = weights * d[i];
    for (int j = i; j < 3; ++j, ++k)
      result(i, j) = result(j, i) = (weights * covariances[k] + weighted * d[j]).sum();
  }
  return result;
}

}  // namespace

MotionFilter::MotionFilter(const MotionOptions& options,
                           double time,
                           const Vector3& position,
                           const Matrix3& covariance)
    : options_(&options),
      time_(time),
      stopped_until_(time),
      changed_until_(time),
      still_p_(position),
      still_pp_(covariance) {
  const int ways = waysToMove(options);
  still_weight_ = options.stop_rate > 0.0 ? 1.0 / (ways + 1) : 0.0;
  moving_weights_.setZero();
  moving_weights_.head(ways).setConstant((1.0 - still_weight_) / ways);
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
  still_pp_.diagonal().array() += square(options_->still_drift) * duration;
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
  const double weight = still_weight_ + stops.sum();
  if (!(weight > 0.0))
    return;
  // By moments about the place of rest, where they stay small.
  const Lanes shares = stops / weight;
  Vector3 step;
  std::array<Lanes, 3> d, share_d;
  for (int i = 0; i < 3; ++i) {
    d[i] = moving_.p[i] - still_p_[i];
    share_d[i] = shares * d[i];
    step[i] = share_d[i].sum();
  }
  const double stays = still_weight_ / weight;
  for (int i = 0, k = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j, ++k) {
      const double second = (shares * moving_.pp[k] + share_d[i] * d[j]).sum();
      still_pp_(i, j) = still_pp_(j, i) = stays * still_pp_(i, j) + second - step[i] * step[j];
    }
  }
  still_p_ += step;
  still_weight_ = weight;
  moving_weights_ -= stops;
}

/// The interaction: each way to move goes on from the mixture of those that may have led to it.
void MotionFilter::change(double duration) {
  const double start = still_weight_ * probabilityOf(options_->start_rate, duration);
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
  moving_.mix(joint, started * inverse, still_p_, still_pp_);

  // What takes up another way does so with an acceleration of that way.
  const Lanes added = taken_up * inverse * accelerationVariances(*options_);
  for (const int diagonal : {0, 3, 5})
    moving_.aa[diagonal] += added;
  still_weight_ -= start;
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
  const double noise_uu = square(smear.x()) + to.pixel_variance_;
  const double noise_uv = smear.x() * smear.y();
  const double noise_vv = square(smear.y()) + to.pixel_variance_;

  double reach = 0.0;
  to.still_weight_ = still_weight_;
  if (still_weight_ > 0.0) {
    const Vector2 offset = H * (still_p_ - mean);
    const Matrix32 gain = still_pp_.lazyProduct(H.transpose());
    const double uu = H.row(0).dot(gain.col(0)) + noise_uu;
    const double uv = H.row(0).dot(gain.col(1)) + noise_uv;
    const double vv = H.row(1).dot(gain.col(1)) + noise_vv;
    to.still_u_ = offset.x();
    to.still_v_ = offset.y();
    to.still_whiten_uu_ = 1.0 / std::sqrt(uu);
    const double l_vu = uv * to.still_whiten_uu_;
    to.still_whiten_vv_ = 1.0 / std::sqrt(vv - l_vu * l_vu);
    to.still_whiten_vu_ = -l_vu * to.still_whiten_uu_ * to.still_whiten_vv_;
    reach = offset.squaredNorm() + uu + vv;
  }

  const auto& pp = moving_.pp;
  Lanes offset_u = Lanes::Zero(), offset_v = Lanes::Zero();
  std::array<Lanes, 3> gain_u, gain_v;
  constexpr int kRows[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (int i = 0; i < 3; ++i) {
    const Lanes d = moving_.p[i] - mean[i];
    offset_u += H(0, i) * d;
    offset_v += H(1, i) * d;
    gain_u[i] = H(0, 0) * pp[kRows[i][0]] + H(0, 1) * pp[kRows[i][1]] + H(0, 2) * pp[kRows[i][2]];
    gain_v[i] = H(1, 0) * pp[kRows[i][0]] + H(1, 1) * pp[kRows[i][1]] + H(1, 2) * pp[kRows[i][2]];
  }
  const Lanes uu = H(0, 0) * gain_u[0] + H(0, 1) * gain_u[1] + H(0, 2) * gain_u[2] + noise_uu;
  const Lanes uv = H(0, 0) * gain_v[0] + H(0, 1) * gain_v[1] + H(0, 2) * gain_v[2] + noise_uv;
  const Lanes vv = H(1, 0) * gain_v[0] + H(1, 1) * gain_v[1] + H(1, 2) * gain_v[2] + noise_vv;
  to.moving_weights_ = moving_weights_;
  to.moving_u_ = offset_u;
  to.moving_v_ = offset_v;
  to.moving_whiten_uu_ = 1.0 / uu.sqrt();
  const Lanes l_vu = uv * to.moving_whiten_uu_;
  to.moving_whiten_vv_ = 1.0 / (vv - l_vu * l_vu).sqrt();
  to.moving_whiten_vu_ = -l_vu * to.moving_whiten_uu_ * to.moving_whiten_vv_;
  const Lanes moving_reach = offset_u.square() + offset_v.square() + uu + vv;
  // (|offset| + sqrt(gate * largest variance))^2 is less, for gates of 1 and more.
  to.squared_reach_ = 2.0 * std::max(reach, moving_reach.maxCoeff());
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
  const double variance = std::max(still_pp_.trace(), variances.maxCoeff());
  return variance * (pixel - prediction.pixel_).squaredNorm() <
         square(kNegligible * depth) * prediction.pixel_variance_;
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
  return true;
}

void MotionFilter::apply(const PixelPrediction& prediction, const Vector2& pixel) {
  const Vector2 from_mean = pixel - prediction.pixel_;
  double still_squared = std::numeric_limits<double>::infinity();
  if (still_weight_ > 0.0) {
    const double u = from_mean.x() - prediction.still_u_;
    const double v = from_mean.y() - prediction.still_v_;
    const double whitened_u = prediction.still_whiten_uu_ * u;
    const double whitened_v = prediction.still_whiten_vu_ * u + prediction.still_whiten_vv_ * v;
    const Vector3 image_u = prediction.jacobian_.row(0).transpose() * prediction.still_whiten_uu_;
    const Vector3 image_v = prediction.jacobian_.row(0).transpose() * prediction.still_whiten_vu_ +
                            prediction.jacobian_.row(1).transpose() * prediction.still_whiten_vv_;
    const Vector3 w_u = still_pp_ * image_u;
    const Vector3 w_v = still_pp_ * image_v;
    still_p_ += w_u * whitened_u + w_v * whitened_v;
    still_pp_ -= w_u * w_u.transpose() + w_v * w_v.transpose();
    still_squared = square(whitened_u) + square(whitened_v);
  }

  Innovations innovations;
  innovations.jacobian = prediction.jacobian_;
  innovations.whiten_uu = prediction.moving_whiten_uu_;
  innovations.whiten_vu = prediction.moving_whiten_vu_;
  innovations.whiten_vv = prediction.moving_whiten_vv_;
  const Lanes u = from_mean.x() - prediction.moving_u_;
  innovations.u = prediction.moving_whiten_uu_ * u;
  innovations.v = prediction.moving_whiten_vu_ * u +
                  prediction.moving_whiten_vv_ * (from_mean.y() - prediction.moving_v_);
  moving_.update(innovations);

  // Probabilities by Bayes; all likelihoods over the greatest exponential, lest all become 0.
  const Lanes squared = innovations.u.square() + innovations.v.square();
  const double least = std::min(still_squared, squared.minCoeff());
  if (still_weight_ > 0.0)
    still_weight_ *= prediction.still_whiten_uu_ * prediction.still_whiten_vv_ *
                     std::exp(0.5 * (least - still_squared));
  moving_weights_ *=
      innovations.whiten_uu * innovations.whiten_vv * (0.5 * (least - squared)).exp();
  const double scale = 1.0 / (still_weight_ + moving_weights_.sum());
  still_weight_ *= scale;
  moving_weights_ *= scale;
}

Vector3 MotionFilter::position() const {
  Vector3 mean = still_weight_ * still_p_;
  for (int i = 0; i < 3; ++i)
    mean[i] += (moving_weights_ * moving_.p[i]).sum();
  return mean;
}

Matrix3 MotionFilter::positionCovariance() const {
  const Vector3 mean = position();
  const Vector3 offset = still_p_ - mean;
  return still_weight_ * (still_pp_ + offset * offset.transpose()) +
         covarianceAbout(mean, moving_weights_, moving_.p, moving_.pp);
}

Vector3 MotionFilter::velocity() const {
  Vector3 mean;
  for (int i = 0; i < 3; ++i)
    mean[i] = (moving_weights_ * moving_.v[i]).sum();
  return mean;
}

Matrix3 MotionFilter::velocityCovariance() const {
  const Vector3 mean = velocity();
  return still_weight_ * mean * mean.transpose() +
         covarianceAbout(mean, moving_weights_, moving_.v, moving_.vv);
}

Matrix2 PixelPrediction::covariance() const {
  Matrix2 covariance = Matrix2::Zero();
  Vector2 mean = Vector2::Zero();
  const auto add = [&](double weight, const Vector2& offset, double uu, double vu, double vv) {
    if (!(weight > 0.0))
      return;
    const double l_uu = 1.0 / uu;
    const double l_vv = 1.0 / vv;
    Matrix2 lower;
    lower << l_uu, 0.0, -vu * l_uu * l_vv, l_vv;
    covariance += weight * (lower * lower.transpose() + offset * offset.transpose());
    mean += weight * offset;
  };
  add(still_weight_, {still_u_, still_v_}, still_whiten_uu_, still_whiten_vu_, still_whiten_vv_);
  for (int i = 0; i < 4; ++i)
    add(moving_weights_[i], {moving_u_[i], moving_v_[i]}, moving_whiten_uu_[i],
        moving_whiten_vu_[i], moving_whiten_vv_[i]);
  return covariance - mean * mean.transpose();
}

PixelPrediction::SquaredDistances PixelPrediction::squaredDistances(const Vector2& pixel) const {
  const Vector2 from_mean = pixel - pixel_;
  SquaredDistances result;
  result.still = std::numeric_limits<double>::infinity();
  if (still_weight_ > 0.0) {
    const double u = from_mean.x() - still_u_;
    const double v = from_mean.y() - still_v_;
    result.still =
        square(still_whiten_uu_ * u) + square(still_whiten_vu_ * u + still_whiten_vv_ * v);
  }
  const Lanes u = from_mean.x() - moving_u_;
  const Lanes v = from_mean.y() - moving_v_;
  result.moving =
      (moving_whiten_uu_ * u).square() + (moving_whiten_vu_ * u + moving_whiten_vv_ * v).square();
  result.least = result.still;
  for (int i = 0; i < 4; ++i) {
    if (moving_weights_[i] > 0.0 && !(result.moving[i] >= result.least))
      result.least = result.moving[i];
  }
  return result;
}

double PixelPrediction::logDensity(const SquaredDistances& distances) const {
  double sum = (moving_weights_ * moving_whiten_uu_ * moving_whiten_vv_ *
                (0.5 * (distances.least - distances.moving)).exp())
                   .sum();
  if (still_weight_ > 0.0)
    sum += still_weight_ * still_whiten_uu_ * still_whiten_vv_ *
           std::exp(0.5 * (distances.least - distances.still));
  return std::log(sum / (2.0 * M_PI)) - 0.5 * distances.least;
}

double PixelPrediction::squaredDistance(const Vector2& pixel) const {
  return squaredDistances(pixel).least;
}

double PixelPrediction::logLikelihood(const Vector2& pixel) const {
  return logDensity(squaredDistances(pixel));
}

std::optional<double> PixelPrediction::logLikelihoodWithin(double gate,
                                                           const Vector2& pixel) const {
  if ((pixel - pixel_).squaredNorm() > gate * squared_reach_)
    return std::nullopt;
  const SquaredDistances distances = squaredDistances(pixel);
  if (!(distances.least <= gate))
    return std::nullopt;
  return logDensity(distances);
}

}  // namespace wiimote_tracker::motion
