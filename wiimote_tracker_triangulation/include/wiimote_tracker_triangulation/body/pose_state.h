#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>

namespace wiimote_tracker::body {

using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Position, rotation, velocity, angular velocity; in the world [m, rad, s].
using MotionVector = Eigen::Matrix<double, 12, 1>;
using MotionCovariance = Eigen::Matrix<double, 12, 12>;

/// Normal distribution of a rigid body's pose and velocities. The rotation's error is a small
/// rotation about the world axes: R_true = exp([w]x) R.
struct PoseState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< In the world [rad/s].
  MotionCovariance covariance = MotionCovariance::Zero();

  void move(const MotionVector& step);

  /// The step that moves the other state here.
  MotionVector minus(const PoseState& other) const;

  /// Constant velocities with white acceleration over a duration [s].
  /// @param acceleration_density [m/s^2 / sqrt(Hz)]
  /// @param angular_acceleration_density [rad/s^2 / sqrt(Hz)]
  void predict(double acceleration_density, double angular_acceleration_density, double duration);

  Eigen::Isometry3d worldFromBody() const;
  PoseCovariance poseCovariance() const { return covariance.topLeftCorner<6, 6>(); }
};

/// Predicted measurement of an LED of a body.
struct LedPrediction {
  Eigen::Vector2d pixel;                 ///< [px]
  Eigen::Matrix2d noise;                 ///< Covariance of a spot without that of the state [px^2].
  Eigen::Matrix2d covariance;            ///< Innovation covariance [px^2].
  Eigen::Matrix<double, 2, 6> jacobian;  ///< d pixel / d (position, rotation) [px/m, px/rad].
  double depth;                          ///< Along the optical axis [m].
};

/// Nothing when the LED is behind the camera. @param led in the body's frame [m]
std::optional<LedPrediction> predictLed(const PoseState& state,
                                        const geometry::Camera& camera,
                                        const Eigen::Vector3d& led,
                                        const geometry::PixelNoise& noise);

}  // namespace wiimote_tracker::body
