#pragma once

#include "motion/kinematic_state.h"
#include "motion/transition.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <functional>

namespace wiimote_tracker {

/// An extended Kalman filter of one motion model, for comparison.
struct SingleModelFilter {
  std::function<motion::Transition(double duration)> model;  ///< Of each axis.
  double pixel_stddev;
  double time;
  motion::KinematicState state;

  void predict(double to);

  /// Linearised at a place. @returns log likelihood of the pixel; the place has none: -infinity.
  double update(const geometry::Camera& camera,
                const Eigen::Vector2d& pixel,
                const Eigen::Vector3d& place);
};

/// At rest; standard deviations of velocity [m/s] and acceleration [m/s^2] per axis.
motion::KinematicState stateAt(const Eigen::Vector3d& position,
                               const Eigen::Matrix3d& covariance,
                               double speed,
                               double acceleration);

}  // namespace wiimote_tracker
