#pragma once

#include "rooms/rig_motion.h"
#include "wiimote_tracker_calibration/remap/fit.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>
#include <vector>

namespace wiimote_tracker::rooms {

/// Two rigs in one world.
struct JoinedRigs {
  geometry::Rig rig;    ///< The first as it was, then the cameras that only the second has.
  RigMotion motion;     ///< From the world of the second to that of the first.
  std::string message;  ///< One sentence: what they share, and how well that agrees.
};

/// Moves the second rig into the world of the first, such that pose and lens of the shared cameras
/// agree or, without any, the common places; weighted by the covariances of both rigs. A shared
/// camera must not have moved in between, and stays as it is in the first rig. The joint covariance
/// is to first order, both rigs being independent.
/// @param places known in the first world, and measured with the second rig: three or more, not on
/// a line. @param stddev of both together, per axis, without the second rig's covariance [m, > 0].
/// @throws Error: neither shared camera nor place; a camera or a place, counted from 1, that
/// contradicts (chi-squared test, 99.9 %); a camera that was moved, has another lens or is another
/// device; a rig without covariance; different ray models.
JoinedRigs joinRigs(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<remap::KnownPoint>& places = {},
                    double stddev = 0.005);

}  // namespace wiimote_tracker::rooms
