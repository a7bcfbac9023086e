#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

/// Gain of a proposal about drift for which a person is asked [px]. Clocks that wander by 1 ms
/// within a minute cause smaller ones, and such changes do not make points more accurate.
constexpr double kWorthAsking = 0.3;

enum class Cause { kKnock, kReconnect, kDrift };

/// A rig that explains what was seen better than the one in use.
struct Proposal {
  Cause cause;
  /// Those that were knocked; of drift, and of new clocks of several, the one that changed most.
  std::vector<std::string> cameras;
  geometry::Rig rig;    ///< As it was found; solved_at: its last image, if poses changed.
  double gain;          ///< Of drift: misfit of the images that it explains, RMS [px]; else 0.
  std::string message;  ///< What has changed, and how well the images fit then.
  /// Where the LED was, world [m]: places that should not jump. Empty if cameras were knocked,
  /// since the others hold the world.
  std::vector<Eigen::Vector3d> places;
};

}  // namespace wiimote_tracker::continuous
