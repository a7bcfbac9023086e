#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_ADJUST_RIG_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_ADJUST_RIG_H

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {

/// How far cameras turn by drift from solved_at to a time [s], standard deviation per axis [rad].
double driftUntil(double time, const geometry::Rig& rig);

/// The rig with its covariance widened by what cameras may have done from solved_at to a time [s].
geometry::Rig withDrift(geometry::Rig rig, double time);

/// Whether the cameras' poses differ by no more than the rig's covariance and the most that cameras
/// drift explain: chi-squared of all poses together, 99.9 %.
bool isWithinDrift(const geometry::Rig& rig, const geometry::Rig& adjusted);

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

/// Copies a camera's time offset and its variance, without its correlations.
void copyClock(const geometry::Rig& from, std::size_t camera, geometry::Rig* to);

/// How well images fit together.
struct Fit {
  double misfit;                        ///< Root mean square of the residuals per axis [px].
  std::vector<Eigen::Vector3d> places;  ///< Where the LED was, world [m].
};

/// The fit of the images of each camera's latest epoch, with the time offsets that hold then.
/// Nothing when three cameras agree on too few places.
std::optional<Fit> fitOf(const geometry::Rig& rig, const std::vector<capture::Image>& images);

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_ADJUST_RIG_H
