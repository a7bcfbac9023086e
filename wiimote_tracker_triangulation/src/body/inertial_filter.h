#pragma once

#include "body/inertial_samples.h"
#include "wiimote_tracker_triangulation/body/pose_state.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wiimote_tracker::body {

/// Errors of an IMU. The defaults suit the cheapest ones, and leave room for errors of the mount.
struct InertialOptions {
  double gyro_density = 1e-3;             ///< White noise [rad/s / sqrt(Hz), > 0].
  double accelerometer_density = 0.01;    ///< White noise [m/s^2 / sqrt(Hz), > 0].
  double gyro_bias = 0.05;                ///< Initial standard deviation per axis [rad/s, > 0].
  double accelerometer_bias = 0.5;        ///< Initial standard deviation per axis [m/s^2, > 0].
  double gyro_bias_walk = 1e-4;           ///< Random walk [rad/s / sqrt(s), >= 0].
  double accelerometer_bias_walk = 2e-3;  ///< Random walk [m/s^2 / sqrt(s), >= 0].
};

/// Pose and velocity of a rigid body with an IMU, and the IMU's biases: an extended Kalman filter
/// that the IMU predicts (J. Sola, "Quaternion kinematics for the error-state Kalman filter", 2017,
/// with errors of rotation about the world's axes). The world's z axis points up. A value type;
/// never allocates.
class InertialFilter {
 public:
  /// @param options not owned. @param start at a time that the samples cover.
  InertialFilter(const InertialOptions& options,
                 double time,
                 const PoseState& start,
                 const InertialSamples& samples);

  double time() const { return time_; }  ///< [s]

  /// Predicts to a time [s] that the samples cover; does nothing unless it is after time().
  void predict(double time, const InertialSamples& samples);

  /// As PoseFilter::update.
  void update(const LedPrediction& prediction, const Eigen::Vector2d& pixel);

  /// Whether its biases are within five of their initial standard deviations. They are not if the
  /// samples contradict the images, as those in another unit, or of another mount or body do.
  bool isPlausible() const;

  const PoseState& state() const { return state_; }

 private:
  /// Position of the IMU [m], rotation about the world's axes [rad], velocity of the IMU [m/s],
  /// biases of gyro [rad/s] and accelerometer [m/s^2].
  using Vector = Eigen::Matrix<double, 15, 1>;
  using Matrix = Eigen::Matrix<double, 15, 15>;

  void read(const InertialSamples& samples);
  void step(const InertialSample& sample, double duration);
  void setState();

  const InertialOptions* options_;
  Eigen::Vector3d imu_;
  double time_;
  Eigen::Vector3d position_;
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d velocity_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_ = Eigen::Vector3d::Zero();
  Matrix covariance_ = Matrix::Zero();
  Eigen::Vector3d rate_;  // measured at time_ [rad/s]
  double rate_variance_;  // of that, by white noise [rad^2/s^2]
  PoseState state_;       // of the body, from all these
};

}  // namespace wiimote_tracker::body
