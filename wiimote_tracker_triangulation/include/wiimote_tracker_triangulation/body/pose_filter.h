#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_POSE_FILTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_POSE_FILTER_H

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>

namespace wiimote_tracker::body {

struct PoseFilterOptions {
  /// Process noise: white acceleration [m/s^2 / sqrt(Hz), >= 0].
  double acceleration_density = 0.7;

  /// Process noise: white angular acceleration [rad/s^2 / sqrt(Hz), >= 0].
  double angular_acceleration_density = 7.0;

  double initial_speed = 2.0;          ///< Initial standard deviation per axis [m/s, > 0].
  double initial_angular_speed = 6.0;  ///< Initial standard deviation per axis [rad/s, > 0].
};

using PoseCovariance = Eigen::Matrix<double, 6, 6>;
using MotionCovariance = Eigen::Matrix<double, 12, 12>;

/// Predicted measurement of an LED of a body.
struct LedPrediction {
  Eigen::Vector2d pixel;                 ///< [px]
  Eigen::Matrix2d covariance;            ///< Innovation covariance [px^2].
  Eigen::Matrix<double, 2, 6> jacobian;  ///< d pixel / d (position, rotation) [px/m, px/rad].
  double depth;                          ///< Along the optical axis [m].
};

/// Extended Kalman filter of a rigid body's pose, velocity and angular velocity, in continuous
/// time; each camera's spots update it at the time of their image. The rotation's error is a small
/// rotation about the world axes: R_true = exp([w]x) R. A value type; never allocates.
class PoseFilter {
 public:
  /// @param options not owned. @param covariance position [m^2], then rotation about the world axes
  /// [rad^2].
  PoseFilter(const PoseFilterOptions& options,
             double time,
             const Eigen::Isometry3d& world_from_body,
             const PoseCovariance& covariance);

  double time() const { return time_; }  ///< [s]

  /// Predicts to a time [s]; does nothing unless it is after time().
  void predict(double time);

  /// At time(). Nothing when the LED is behind the camera.
  std::optional<LedPrediction> predictLed(const geometry::Camera& camera,
                                          const Eigen::Vector3d& led,
                                          double pixel_stddev) const;

  /// Updates with the pixel of an LED's spot at time(). The prediction must stem from the present
  /// state: every update changes it.
  void update(const LedPrediction& prediction, const Eigen::Vector2d& pixel, double pixel_stddev);

  Eigen::Isometry3d worldFromBody() const;
  PoseCovariance poseCovariance() const { return covariance_.topLeftCorner<6, 6>(); }

  /// Order: position, rotation, velocity, angular velocity.
  const MotionCovariance& covariance() const { return covariance_; }
  const Eigen::Vector3d& velocity() const { return velocity_; }        ///< World [m/s].
  const Eigen::Vector3d& angularVelocity() const { return turning_; }  ///< World [rad/s].

 private:
  using State = Eigen::Matrix<double, 12, 1>;

  const PoseFilterOptions* options_;
  double time_;
  Eigen::Vector3d position_;
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d turning_ = Eigen::Vector3d::Zero();
  MotionCovariance covariance_;
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_POSE_FILTER_H
