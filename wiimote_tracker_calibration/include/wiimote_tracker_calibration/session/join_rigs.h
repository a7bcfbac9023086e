#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_JOIN_RIGS_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_JOIN_RIGS_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// Two rigs in one world.
struct JoinedRigs {
  geometry::Rig rig;  ///< The first as it was, then the cameras that only the second has.
  Eigen::Isometry3d first_from_second;  ///< World of the second in the world of the first [m].
  std::vector<std::string> shared;      ///< Cameras over which they were joined.
  /// Disagreement of the two rigs and what is to be expected of it on average: its degrees of
  /// freedom (chi-squared).
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;
  std::string message;  ///< One sentence: over what they were joined, and how well that fits.
};

/// Puts the second rig into the world of the first. They share one camera or more, which did not
/// move in between: the second is moved so that these coincide, each with its uncertainty in both
/// rigs. A shared camera stays as the first rig has it. The joint covariance follows to first order
/// from those of both rigs, taken as independent.
/// @throws SessionError: nothing shared; a camera that contradicts (chi-squared, 99.9 %), moved,
/// or is another device; a rig without covariance; different ray models.
JoinedRigs joinRigs(const geometry::Rig& first, const geometry::Rig& second);

/// A place that is known in the first world and was measured with the second rig.
struct CommonPlace {
  Eigen::Vector3d in_first;   ///< [m]
  Eigen::Vector3d in_second;  ///< [m]
  double stddev = 0.005;      ///< Of both together but for the second's calibration [m, > 0].
};

/// Same over three places or more, not on one line, for rigs without a common camera.
/// @throws SessionError as above; names the place that contradicts, counted from 1.
JoinedRigs joinRigs(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<CommonPlace>& places);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_JOIN_RIGS_H
