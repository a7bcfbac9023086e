#include "body/inertial_filter.h"

#include "pixel_update.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::body {
namespace {

namespace so3 = geometry::so3;

enum Block { kPosition = 0, kRotation = 3, kVelocity = 6, kGyroBias = 9, kForceBias = 12 };

constexpr double kGravity = 9.80665;  // standard gravity [m/s^2]

}  // namespace

InertialFilter::InertialFilter(const InertialOptions& options,
                               double time,
                               const PoseState& start,
                               const InertialSamples& samples)
    : options_(&options), imu_(samples.place()), time_(time), rotation_(start.rotation) {
  const Eigen::Vector3d arm = rotation_ * imu_;
  position_ = start.position + arm;
  velocity_ = start.velocity + start.angular_velocity.cross(arm);
  // Columns as in MotionVector: the angular velocity starts at 9.
  Eigen::Matrix<double, 9, 12> by_start = Eigen::Matrix<double, 9, 12>::Identity();
  by_start.block<3, 3>(kPosition, kRotation) = -so3::skew(arm);
  by_start.block<3, 3>(kVelocity, kRotation) = -so3::skew(start.angular_velocity) * so3::skew(arm);
  by_start.block<3, 3>(kVelocity, 9) = -so3::skew(arm);
  covariance_.topLeftCorner<9, 9>() = by_start * start.covariance * by_start.transpose();
  covariance_.diagonal().segment<3>(kGyroBias).setConstant(std::pow(options.gyro_bias, 2));
  covariance_.diagonal()
      .segment<3>(kForceBias)
      .setConstant(std::pow(options.accelerometer_bias, 2));
  read(samples);
}

/// Takes the angular velocity from the samples, and sets the body's state.
void InertialFilter::read(const InertialSamples& samples) {
  rate_ = samples.at(time_).rate;
  rate_variance_ = std::pow(options_->gyro_density, 2) * samples.frequency();
  setState();
}

void InertialFilter::predict(double time, const InertialSamples& samples) {
  if (!(time > time_))
    return;
  while (time_ < time) {
    const double end = std::min(time, samples.nextAfter(time_));
    step(samples.at(0.5 * (time_ + end)), end - time_);
    time_ = end;
  }
  read(samples);
}

/// Constant rate and force over a duration [s]. Derivatives as in Sola 2017, chapter 7, but with
/// the rotation in the middle of the step.
void InertialFilter::step(const InertialSample& sample, double duration) {
  const double h = duration;
  const Eigen::Vector3d rate = sample.rate - gyro_bias_;
  const Eigen::Matrix3d middle = (rotation_ * so3::exp(0.5 * h * rate)).toRotationMatrix();
  const Eigen::Vector3d force = middle * (sample.force - accelerometer_bias_);
  const Eigen::Vector3d acceleration = force - kGravity * Eigen::Vector3d::UnitZ();
  position_ += h * velocity_ + 0.5 * h * h * acceleration;
  velocity_ += h * acceleration;
  rotation_ = (rotation_ * so3::exp(h * rate)).normalized();

  Matrix transition = Matrix::Identity();
  const auto block = [&transition](Block row, Block column) {
    return transition.block<3, 3>(row, column);
  };
  block(kRotation, kGyroBias) = -h * middle;
  block(kVelocity, kRotation) = -h * so3::skew(force);
  block(kVelocity, kForceBias) = -h * middle;
  block(kPosition, kVelocity).diagonal().setConstant(h);
  block(kPosition, kRotation) = -0.5 * h * h * so3::skew(force);
  block(kPosition, kForceBias) = -0.5 * h * h * middle;
  const Matrix left = transition * covariance_;
  covariance_.noalias() = left * transition.transpose();

  const auto addNoise = [&](Block row, Block column, double variance) {
    covariance_.block<3, 3>(row, column).diagonal().array() += variance;
  };
  const double of_force = std::pow(options_->accelerometer_density, 2) * h;
  addNoise(kRotation, kRotation, std::pow(options_->gyro_density, 2) * h);
  addNoise(kVelocity, kVelocity, of_force);
  addNoise(kPosition, kVelocity, of_force * h / 2.0);
  addNoise(kVelocity, kPosition, of_force * h / 2.0);
  addNoise(kPosition, kPosition, of_force * h * h / 3.0);
  addNoise(kGyroBias, kGyroBias, std::pow(options_->gyro_bias_walk, 2) * h);
  addNoise(kForceBias, kForceBias, std::pow(options_->accelerometer_bias_walk, 2) * h);
}

void InertialFilter::update(const LedPrediction& prediction, const Eigen::Vector2d& pixel) {
  // The body's origin is at position - arm, which turns with the body.
  Eigen::Matrix<double, 2, 6> jacobian = prediction.jacobian;
  jacobian.rightCols<3>() += prediction.jacobian.leftCols<3>() * so3::skew(rotation_ * imu_);
  Vector step;
  updateByPixel(jacobian, pixel - prediction.pixel, prediction.noise, &covariance_, &step);
  position_ += step.segment<3>(kPosition);
  rotation_ = (so3::exp(step.segment<3>(kRotation)) * rotation_).normalized();
  velocity_ += step.segment<3>(kVelocity);
  gyro_bias_ += step.segment<3>(kGyroBias);
  accelerometer_bias_ += step.segment<3>(kForceBias);
  setState();
}

bool InertialFilter::isPlausible() const {
  constexpr double kSigmas = 5.0;
  return gyro_bias_.lpNorm<Eigen::Infinity>() < kSigmas * options_->gyro_bias &&
         accelerometer_bias_.lpNorm<Eigen::Infinity>() < kSigmas * options_->accelerometer_bias;
}

void InertialFilter::setState() {
  const Eigen::Matrix3d turn = rotation_.toRotationMatrix();
  const Eigen::Vector3d arm = turn * imu_;
  const Eigen::Vector3d rate = turn * (rate_ - gyro_bias_);
  state_.position = position_ - arm;
  state_.rotation = rotation_;
  state_.velocity = velocity_ - rate.cross(arm);
  state_.angular_velocity = rate;

  // Rows as in MotionVector: velocity from 6, angular velocity from 9.
  Eigen::Matrix<double, 12, 15> by_filter = Eigen::Matrix<double, 12, 15>::Zero();
  by_filter.topLeftCorner<9, 9>().setIdentity();
  by_filter.block<3, 3>(0, kRotation) = so3::skew(arm);
  by_filter.block<3, 3>(6, kRotation) = so3::skew(rate.cross(arm));
  by_filter.block<3, 3>(6, kGyroBias) = -so3::skew(arm) * turn;
  by_filter.block<3, 3>(9, kRotation) = -so3::skew(rate);
  by_filter.block<3, 3>(9, kGyroBias) = -turn;
  const Eigen::Matrix<double, 12, 15> left = by_filter * covariance_;
  state_.covariance.noalias() = left * by_filter.transpose();
  Eigen::Matrix<double, 6, 3> by_rate;  // of velocity and angular velocity
  by_rate << so3::skew(arm), Eigen::Matrix3d::Identity();
  state_.covariance.bottomRightCorner<6, 6>() += rate_variance_ * by_rate * by_rate.transpose();
}

}  // namespace wiimote_tracker::body
