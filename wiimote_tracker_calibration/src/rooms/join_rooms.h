#pragma once

#include "rooms/walker.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::rooms {

struct JoinOptions {
  /// Standard deviation of the share by which a walker is slower, or faster, while the LED is
  /// hidden, in all passages alike [1, >= 0]. Assumed: people slow down the more, the narrower the
  /// opening (K. Wilmut and A. L. Barnett, "Locomotor adjustments when navigating through
  /// apertures", Hum. Mov. Sci. 29(2), 2010).
  double slowing = 0.03;
  /// Standard deviation of the angle between the verticals (z axes) of both worlds, about each
  /// horizontal axis [rad, > 0]. The default: a flat floor may differ by 10 mm over 4 m (DIN
  /// 18202), which is 0.14 degrees, in both rooms. Infinite: a world may have any slope; then only
  /// the passages say how the rooms are tilted.
  double slope = 0.2 * M_PI / 180.0;
};

/// Two rooms in one world.
struct JoinedRooms {
  geometry::Rig rig;                    ///< The first as it was, then the cameras of the second.
  Eigen::Isometry3d first_from_second;  ///< World of the second in the world of the first [m].
  double position_stddev;               ///< Of the middle of the second room's cameras, in 3D [m].
  double rotation_stddev;               ///< About all axes together [rad].
  std::size_t passages;                 ///< That were used.
  std::string message;  ///< What was used and left out, the accuracy, what to do next.
};

/// Joins two rigs that share no view by an LED that was carried through the door between them. Both
/// rigs' tracks have the same clock. On either side of the door the LED's path is a straight line
/// at constant velocity, with deviations (walker.h); both lines must agree. The scatter of the
/// passages corrects the size of these deviations ahead, to the left and up, for the weights and
/// for the covariance, which includes those of both rigs and the slope, to first order. A passage
/// that contradicts the others (99.9 %) is left out, at most a third of them.
/// @param first_tracks, second_tracks as of findPassages()
/// @throws Error: no passage, passages that contradict one another or leave the motion open; rigs
/// that cannot be joined (checkRigs) or share a camera; a world whose z axis is not
/// vertical by the accelerometers, unless the slope is infinite.
JoinedRooms joinRooms(const geometry::Rig& first,
                      const geometry::Rig& second,
                      const std::vector<Path>& first_tracks,
                      const std::vector<Path>& second_tracks,
                      const JoinOptions& options);

}  // namespace wiimote_tracker::rooms
