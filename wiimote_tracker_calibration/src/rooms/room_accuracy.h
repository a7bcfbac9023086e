#pragma once

#include "rooms/rig_motion.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <string>

namespace wiimote_tracker::rooms {

/// How well the second room is known in the world of the first: standard deviations of a point,
/// without the second rig's own errors, in 3D [m], and of the rotation about all axes [rad].
struct RoomAccuracy {
  double position;
  double rotation;

  /// Whether it is within wantedAccuracy().
  bool isAsWanted() const;
};

/// 5 cm and 0.5 degrees, in words.
std::string wantedAccuracy();

/// @param point in the second world [m].
RoomAccuracy accuracyOf(const RigMotion& motion, const Eigen::Vector3d& point);

/// Mean of the positions of the cameras that only the second rig has, in its world [m].
Eigen::Vector3d middleOfSecond(const geometry::Rig& first, const geometry::Rig& second);

/// In words. @param accuracy at the middle of the second's cameras.
std::string describe(const RoomAccuracy& accuracy);

}  // namespace wiimote_tracker::rooms
