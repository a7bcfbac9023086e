#pragma once

#include "wiimote_tracker_triangulation/body/pose_state.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

struct BodySetup;
struct BodyState;

/// Estimate of one LED of a body.
struct LedEstimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< From the pose, in the world [m].

  /// Cameras that show it in their newest image, not older than BodyTrackerOptions::tracked_time.
  std::vector<std::size_t> cameras;

  /// Distance of the newest spot from its prediction: in the image [px], and across the line of
  /// sight at the LED's depth [m]. NaN without cameras.
  double residual = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();

  /// [s]; minus infinity: not seen since the body was found.
  double last_observed = -std::numeric_limits<double>::infinity();
};

/// A body at the time of the newest image.
struct BodyEstimate {
  bool tracked = false;   ///< False: hidden, the pose is extrapolated.
  bool inertial = false;  ///< By an IMU, since the body was last seen.
  bool lost = false;      ///< The last estimate: the pose is unknown from here on.
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();  ///< [m]

  /// Order: position [m^2], rotation about the world axes [rad^2], velocity [m^2/s^2], angular
  /// velocity [rad^2/s^2]. The pose's block includes the errors of the calibration where the rig
  /// has their covariance; on velocities their effect is negligible.
  MotionCovariance covariance = MotionCovariance::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< World [m/s].
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< World [rad/s].
  std::vector<LedEstimate> leds;                               ///< As in the constellation.
  double first_seen = 0.0;                                     ///< [s]
  double last_observed = 0.0;                                  ///< [s]
};

/// Writes what is known of a body at the time of the newest image [s].
void estimateBody(std::size_t body,
                  double time,
                  const BodySetup& setup,
                  const BodyState& state,
                  std::optional<BodyEstimate>* estimate);

}  // namespace wiimote_tracker::body
