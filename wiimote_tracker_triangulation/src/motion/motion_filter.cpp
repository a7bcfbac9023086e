#include "motion/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::motion {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// Shortest interval between two mixings of moving modes into those at rest [s]. With a longer one,
/// the state at rest of an LED that stops would be where the LED was at the last mixing.
constexpr double kStopInterval = 0.002;

/// Shortest interval between the other mixings [s]: an LED hardly moves in it.
constexpr double kChangeInterval = 0.01;

/// L^-1 of a covariance L L^T whose variances are at least `least`: rounding may leave less of a
/// very large covariance. @returns lower triangular
Matrix2d whiteningOf(const Matrix2d& covariance, double least) {
  const double w_uu = 1.0 / std::sqrt(std::max(covariance(0, 0), least));
  const double l_vu = covariance(0, 1) * w_uu;
  const double w_vv = 1.0 / std::sqrt(std::max(covariance(1, 1) - l_vu * l_vu, least));
  Matrix2d result;
  result << w_uu, 0.0, -l_vu * w_uu * w_vv, w_vv;
  return result;
}

}  // namespace

MotionFilter::MotionFilter(const MotionOptions& options,
                           double time,
                           const Vector3d& position,
                           const Matrix3d& covariance)
    : options_(&options),
      time_(time),
      last_stop_(time),
      last_change_(time),
      last_update_(time),
      last_change_of_camera_(time),
      last_viewpoint_(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())),
      modes_(initialModes(options, position, covariance)) {}

void MotionFilter::predict(double time) {
  if (!(time > time_) || !std::isfinite(time))
    return;
  for (int i = 0; i < kModes; ++i) {
    if (modes_[i].probability > 0.0)
      motion::predict(*options_, i, time - time_, &modes_[i].state);
  }
  time_ = time;
  // Mixed after the prediction, not before as in the textbook: the mode changes at the end.
  if (time - last_stop_ >= kStopInterval) {
    mixStops(*options_, time - last_stop_, &modes_);
    last_stop_ = time;
  }
  if (time - last_change_ >= kChangeInterval) {
    mixChanges(*options_, time - last_change_, &modes_);
    last_change_ = time;
  }
}

std::optional<PixelPrediction> MotionFilter::predictPixel(const geometry::Camera& camera,
                                                          const geometry::PixelNoise& noise) const {
  PixelPrediction prediction;
  prediction.velocity_ = velocity();
  prediction.stamp_stddev_ = noise.stamp_stddev;
  prediction.pixel_variance_ = std::pow(noise.pixel_stddev, 2);
  if (!linearize(camera, position(), &prediction))
    return std::nullopt;
  return prediction;
}

/// Predicts the pixel with the derivatives at a point, which need not be the mean. False when the
/// camera does not see the point.
bool MotionFilter::linearize(const geometry::Camera& camera,
                             const Vector3d& point,
                             PixelPrediction* prediction) const {
  PixelPrediction& to = *prediction;
  const std::optional<Vector2d> pixel = camera.project(point, &to.jacobian_);
  if (!pixel)
    return false;
  const Matrix23& H = to.jacobian_;
  const Vector3d mean = position();
  to.pixel_ = *pixel + H * (mean - point);
  const double stamp_variance = to.stamp_stddev_ * to.stamp_stddev_;
  const Matrix2d noise = to.pixel_variance_ * Matrix2d::Identity();
  for (int i = 0; i < kModes; ++i) {
    const KinematicState& state = modes_[i].state;
    PixelPrediction::ModePixel& mode = to.modes_[i];
    mode.probability = modes_[i].probability;
    if (!(mode.probability > 0.0))
      continue;
    mode.offset = H * (state.position() - mean);
    // In an error of the time the LED moves: by a velocity that may itself be unknown.
    const Vector3d v = state.velocity();
    const Matrix3d spread = state.positionCovariance() +
                            stamp_variance * (state.velocityCovariance() + v * v.transpose());
    const Matrix23 HP = H * spread;
    mode.whitening = whiteningOf(HP * H.transpose() + noise, to.pixel_variance_);
  }
  return true;
}

/// Whether the projection is linear over the uncertainty of the position, but for a small part of
/// the pixel noise: a displacement d changes its derivatives by about d / depth of themselves.
bool MotionFilter::isLinear(const geometry::Camera& camera,
                            const PixelPrediction& prediction,
                            const Vector2d& pixel) const {
  constexpr double kNegligible = 0.05;  // of the noise's standard deviation
  const double depth = camera.world_from_camera.linear().col(2).dot(position() - camera.center());
  double variance = 0.0;
  for (const Mode& mode : modes_) {
    if (mode.probability > 0.0)
      variance = std::max(variance, mode.state.positionCovariance().trace());
  }
  return variance * (pixel - prediction.pixel_).squaredNorm() <
         std::pow(kNegligible * depth, 2) * prediction.pixel_variance_;
}

bool MotionFilter::update(const geometry::Camera& camera,
                          const PixelPrediction& prediction,
                          const Vector2d& pixel) {
  constexpr int kIterations = 3;
  constexpr double kFarthest = 1e9;  // [px]
  if (!((pixel - prediction.pixel_).squaredNorm() < kFarthest * kFarthest))
    return false;
  if (camera.center() != last_viewpoint_) {
    last_viewpoint_ = camera.center();
    last_change_of_camera_ = time_;
  }
  const std::optional<Vector3d> ray = rayIfAlone(camera);
  if (isLinear(camera, prediction, pixel)) {
    apply(prediction, pixel, ray);
  } else {
    // The iterated extended Kalman filter: linearised again at its own result.
    const MotionFilter before = *this;
    apply(prediction, pixel, ray);
    PixelPrediction closer = prediction;
    for (int i = 0; i < kIterations; ++i) {
      if (!before.linearize(camera, position(), &closer))
        break;
      *this = before;
      apply(closer, pixel, ray);
    }
  }
  if (ray)
    decayAlong(*ray, time_ - last_update_);
  last_update_ = time_;
  return true;
}

/// The direction from the camera to the LED if for a while no other camera has seen it. Pixels of
/// one camera do not tell the distance. A filter would still take it from the motion, since a near
/// LED needs less speed and acceleration for the same pixels: so it would come to the camera.
std::optional<Vector3d> MotionFilter::rayIfAlone(const geometry::Camera& camera) const {
  constexpr double kDelay = 0.05;  // [s]
  if (!(time_ - last_change_of_camera_ > kDelay))
    return std::nullopt;
  return (position() - camera.center()).normalized();
}

/// Updates each mode's state, and the mode probabilities by Bayes' theorem. With a ray, nothing is
/// learned of the states along it.
void MotionFilter::apply(const PixelPrediction& prediction,
                         const Vector2d& pixel,
                         const std::optional<Vector3d>& ray) {
  constexpr double kNegligible = 1e-100;
  const PixelPrediction::Distances distances = prediction.distancesTo(pixel);
  double sum = 0.0;
  for (int i = 0; i < kModes; ++i) {
    Mode& mode = modes_[i];
    if (!(mode.probability > 0.0))
      continue;
    const PixelPrediction::ModePixel& predicted = prediction.modes_[i];
    const Vector2d innovation = pixel - prediction.pixel_ - predicted.offset;
    if (isAtRest(i))
      mode.state.update<3>(prediction.jacobian_, predicted.whitening, innovation, ray);
    else
      mode.state.update<9>(prediction.jacobian_, predicted.whitening, innovation, ray);
    mode.probability *= prediction.scaledDensity(i, distances);
    sum += mode.probability;
  }
  // Negligible probabilities become zero: then probability times likelihood stays positive for at
  // least one mode, whatever the pixel.
  for (Mode& mode : modes_) {
    mode.probability /= sum;
    if (mode.probability <= kNegligible)
      mode.probability = 0.0;
  }
}

/// What is known of velocity and acceleration along the ray becomes outdated while one camera alone
/// sees the LED: they decay to zero, with the variance of a motion of the same speed in any
/// direction.
void MotionFilter::decayAlong(const Vector3d& ray, double duration) {
  constexpr double kDecayTime = 1.0;  // to 1/e [s]
  const double mean_square = (velocityCovariance().trace() + velocity().squaredNorm()) / 3.0;
  for (int i = kRestModes; i < kModes; ++i)
    modes_[i].state.decay(ray, std::exp(-duration / kDecayTime), mean_square,
                          accelerationVariance(*options_, i));
}

/// Mean over the modes of three values of the state. @param first index of them
Vector3d MotionFilter::mean(int first) const {
  Vector3d mean = Vector3d::Zero();
  for (const Mode& mode : modes_)
    mean += mode.probability * mode.state.mean.segment<3>(first);
  return mean;
}

/// Their covariance.
Matrix3d MotionFilter::covariance(int first) const {
  const Vector3d mean = this->mean(first);
  Matrix3d result = Matrix3d::Zero();
  for (const Mode& mode : modes_) {
    const Vector3d d = mode.state.mean.segment<3>(first) - mean;
    result +=
        mode.probability * (mode.state.covariance.block<3, 3>(first, first) + d * d.transpose());
  }
  return result;
}

}  // namespace wiimote_tracker::motion
