#pragma once

#include "description.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wiimote_tracker::simulation {

/// An upright opaque cylinder.
struct Cylinder {
  Eigen::Vector3d foot;  ///< Centre of the lower end, world [m].
  double radius;         ///< [m]
  double height;         ///< [m]

  /// Whether it intersects the segment between two points [m].
  bool hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

/// From the axes of the LEDs that somebody carries: origin on the floor, x forward (along the
/// world's x at time 0), z up. `time` [s].
Eigen::Isometry3d worldFrom(const PersonDescription& carrier, double time);

/// From the axes of a body, which are parallel to the world's at time 0. `time` [s].
Eigen::Isometry3d worldFrom(const RigidBodyDescription& carrier, double time);

/// What of a person occludes LEDs at `time` [s].
Cylinder cylinderOf(const PersonDescription& person, double time);

}  // namespace wiimote_tracker::simulation
