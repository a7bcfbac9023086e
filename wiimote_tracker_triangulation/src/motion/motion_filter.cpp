#include "wiimote_tracker_triangulation/motion/motion_filter.h"

#include "motion_steps.h"

#include <algorithm>
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

/// Changes between ways to move are followed at every image, but no more finely than this [s]. Any
/// less would cost accuracy where an LED stops: what is still is then where it last was followed.
constexpr double kChangeInterval = 0.002;

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

}  // namespace

MotionFilter::MotionFilter(const MotionOptions& options,
                           double time,
                           const Vector3& position,
                           const Matrix3& covariance)
    : options_(&options),
      time_(time),
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
  if (!(time > time_) || !std::isfinite(time))
    return;
  const double duration = time - time_;
  moving_.predict(motionSteps(*options_, duration));
  still_pp_.diagonal().array() += square(options_->still_drift) * duration;
  time_ = time;
  if (time - changed_until_ >= kChangeInterval) {
    change(time - changed_until_);
    changed_until_ = time;
  }
}

/// The interaction: each way to move goes on from the mixture of those that may have led to it.
void MotionFilter::change(double duration) {
  // Joint probabilities of the way before (column) and the way after (row).
  const double start = still_weight_ * probabilityOf(options_->start_rate, duration);
  const int ways = waysToMove(*options_);
  Eigen::Matrix4d joint = Eigen::Matrix4d::Zero();
  Lanes stop = Lanes::Zero();
  for (int i = 0; i < ways; ++i) {
    const int rasher = ways - 1 - i;
    const double rise = rasher > 0 ? options_->rise_rate : 0.0;
    const double settle = i > 0 ? options_->settle_rate : 0.0;
    const double rate = options_->stop_rate + rise + settle;
    const double per_rate =  // probability for each 1/s
        moving_weights_[i] * duration / (1.0 + rate * duration);
    stop[i] = per_rate * options_->stop_rate;
    for (int j = 0; j < ways; ++j)
      joint(j, i) = j < i ? per_rate * settle / i : per_rate * rise / rasher;
    joint(i, i) = moving_weights_[i] - per_rate * rate;
  }
  Lanes started = Lanes::Zero();
  started.head(ways).setConstant(start / ways);
  const Lanes weights = joint.rowwise().sum().array() + started;

  // What takes up another way does so with an acceleration of that way.
  const Lanes taken_up =
      started +
      joint.triangularView<Eigen::StrictlyLower>().toDenseMatrix().rowwise().sum().array();
  const Lanes inverse = (weights > 0.0).select(1.0 / weights, 0.0);
  const Eigen::Matrix4d shares = inverse.matrix().asDiagonal() * joint;

  const double still_weight = still_weight_ - start + stop.sum();
  const Vector3 rest_p = still_p_;
  const Matrix3 rest_pp = still_pp_;
  if (still_weight > 0.0) {
    const double stays = (still_weight_ - start) / still_weight;
    const Lanes stops = stop / still_weight;
    Vector3 step = Vector3::Zero();  // from rest_p
    Matrix3 second = stays * rest_pp;
    for (int i = 0; i < kMoving; ++i) {
      const Vector3 d = moving_.position(i) - rest_p;
      step += stops[i] * d;
      second += stops[i] * (moving_.positionCovariance(i) + d * d.transpose());
    }
    still_p_ += step;
    still_pp_ = second - step * step.transpose();
  }
  moving_.mix(shares, started * inverse, rest_p, rest_pp);
  const Lanes added = taken_up * inverse * accelerationVariances(*options_);
  for (const int diagonal : {0, 3, 5})
    moving_.aa[diagonal] += added;
  still_weight_ = still_weight;
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
  const std::optional<Vector2> pixel = camera.project(point, &prediction->jacobian_);
  if (!pixel)
    return false;
  const Matrix23& H = prediction->jacobian_;
  const Vector3 mean = position();
  prediction->pixel_ = *pixel + H * (mean - point);
  const Vector2 smear = H * prediction->smear_;
  const double noise_uu = square(smear.x()) + prediction->pixel_variance_;
  const double noise_uv = smear.x() * smear.y();
  const double noise_vv = square(smear.y()) + prediction->pixel_variance_;

  PixelPrediction::Component& still = prediction->components_[0];
  still.weight = still_weight_;
  if (still.weight > 0.0) {
    still.offset.noalias() = H * (still_p_ - mean);
    const Matrix32 gain = still_pp_ * H.transpose();
    const double uu = H.row(0).dot(gain.col(0)) + noise_uu;
    const double uv = H.row(0).dot(gain.col(1)) + noise_uv;
    const double vv = H.row(1).dot(gain.col(1)) + noise_vv;
    still.whiten_uu = 1.0 / std::sqrt(uu);
    const double l_vu = uv * still.whiten_uu;
    still.whiten_vv = 1.0 / std::sqrt(vv - l_vu * l_vu);
    still.whiten_vu = -l_vu * still.whiten_uu * still.whiten_vv;
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
  const Lanes whiten_uu = 1.0 / uu.sqrt();
  const Lanes l_vu = uv * whiten_uu;
  const Lanes whiten_vv = 1.0 / (vv - l_vu * l_vu).sqrt();
  const Lanes whiten_vu = -l_vu * whiten_uu * whiten_vv;
  for (int i = 0; i < kMoving; ++i) {
    PixelPrediction::Component& component = prediction->components_[i + 1];
    component.weight = moving_weights_[i];
    component.offset = {offset_u[i], offset_v[i]};
    component.whiten_uu = whiten_uu[i];
    component.whiten_vu = whiten_vu[i];
    component.whiten_vv = whiten_vv[i];
  }
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
  const PixelPrediction::Component& still = prediction.components_[0];
  double still_squared = std::numeric_limits<double>::infinity();
  if (still.weight > 0.0) {
    const Vector2 whitened = still.whitened(from_mean);
    const Vector3 image_u = prediction.jacobian_.row(0).transpose() * still.whiten_uu;
    const Vector3 image_v = prediction.jacobian_.row(0).transpose() * still.whiten_vu +
                            prediction.jacobian_.row(1).transpose() * still.whiten_vv;
    const Vector3 w_u = still_pp_ * image_u;
    const Vector3 w_v = still_pp_ * image_v;
    still_p_ += w_u * whitened.x() + w_v * whitened.y();
    still_pp_ -= w_u * w_u.transpose() + w_v * w_v.transpose();
    still_squared = whitened.squaredNorm();
  }

  Innovations innovations;
  innovations.jacobian = prediction.jacobian_;
  for (int i = 0; i < kMoving; ++i) {
    const PixelPrediction::Component& component = prediction.components_[i + 1];
    innovations.whiten_uu[i] = component.whiten_uu;
    innovations.whiten_vu[i] = component.whiten_vu;
    innovations.whiten_vv[i] = component.whiten_vv;
    const Vector2 whitened = component.whitened(from_mean);
    innovations.u[i] = whitened.x();
    innovations.v[i] = whitened.y();
  }
  moving_.update(innovations);

  // Probabilities by Bayes; all likelihoods over the greatest exponential, lest all become 0.
  const Lanes squared = innovations.u.square() + innovations.v.square();
  const double least = std::min(still_squared, squared.minCoeff());
  still_weight_ = still.weight > 0.0 ? still.weight * still.whiten_uu * still.whiten_vv *
                                           std::exp(0.5 * (least - still_squared))
                                     : 0.0;
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
  Matrix3 covariance = still_weight_ * (still_pp_ + offset * offset.transpose());
  for (int i = 0; i < kMoving; ++i) {
    const Vector3 d = moving_.position(i) - mean;
    covariance += moving_weights_[i] * (moving_.positionCovariance(i) + d * d.transpose());
  }
  return covariance;
}

Vector3 MotionFilter::velocity() const {
  Vector3 mean;
  for (int i = 0; i < 3; ++i)
    mean[i] = (moving_weights_ * moving_.v[i]).sum();
  return mean;
}

Matrix3 MotionFilter::velocityCovariance() const {
  const Vector3 mean = velocity();
  Matrix3 covariance = still_weight_ * mean * mean.transpose();
  for (int i = 0; i < kMoving; ++i) {
    const Vector3 d = moving_.velocity(i) - mean;
    covariance += moving_weights_[i] * (moving_.velocityCovariance(i) + d * d.transpose());
  }
  return covariance;
}

Vector2 PixelPrediction::Component::whitened(const Vector2& from_mean) const {
  const Vector2 d = from_mean - offset;
  return {whiten_uu * d.x(), whiten_vu * d.x() + whiten_vv * d.y()};
}

Matrix2 PixelPrediction::covariance() const {
  Matrix2 covariance = Matrix2::Zero();
  Vector2 mean = Vector2::Zero();
  for (const Component& c : components_) {
    if (!(c.weight > 0.0))
      continue;
    const double l_uu = 1.0 / c.whiten_uu;
    const double l_vv = 1.0 / c.whiten_vv;
    const double l_vu = -c.whiten_vu * l_uu * l_vv;
    Matrix2 lower;
    lower << l_uu, 0.0, l_vu, l_vv;
    covariance += c.weight * (lower * lower.transpose() + c.offset * c.offset.transpose());
    mean += c.weight * c.offset;
  }
  return covariance - mean * mean.transpose();
}

double PixelPrediction::squaredDistance(const Vector2& pixel) const {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const Component& c : components_) {
    if (!(c.weight > 0.0))
      continue;
    const double squared = c.whitened(pixel - pixel_).squaredNorm();
    if (!(squared >= least))
      least = squared;
  }
  return least;
}

double PixelPrediction::logLikelihood(const Vector2& pixel) const {
  double squared[5];
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    squared[i] = std::numeric_limits<double>::infinity();
    if (components_[i].weight > 0.0)
      squared[i] = components_[i].whitened(pixel - pixel_).squaredNorm();
    least = std::min(least, squared[i]);
  }
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) {
    const Component& c = components_[i];
    if (c.weight > 0.0)
      sum += c.weight * c.whiten_uu * c.whiten_vv * std::exp(0.5 * (least - squared[i]));
  }
  return std::log(sum / (2.0 * M_PI)) - 0.5 * least;
}

}  // namespace wiimote_tracker::motion
