#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_ADJUST_RIG_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_ADJUST_RIG_H

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {

/// All cameras adjusted together to images of one moving LED: maximum a posteriori pose, lens and
/// time offset, the prior being the rig with its joint covariance, and the drift since solved_at.
/// Cameras turn more easily than they move, so that their places hold the world. Known time offsets
/// change against each other only: the median stays. The covariance of the clocks is that against
/// their mean. A camera whose rig has no time offset keeps none: it is solved with one that is then
/// forgotten.
/// @returns the rig with its covariance, but without solved_at and verdict; nothing when the rig
/// has no covariance, when three cameras agree on too few places, or when these lie together.
std::optional<geometry::Rig> adjustRig(const geometry::Rig& rig,
                                       const std::vector<capture::Image>& images);

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_ADJUST_RIG_H
