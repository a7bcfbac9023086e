#pragma once

#include "continuous/keyframes.h"
#include "continuous/proposal.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <optional>
#include <vector>

/// All cameras adjusted together: what they and their clocks may have done, and what is proposed.
namespace wiimote_tracker::continuous {

/// How far cameras turn by drift from solved_at to a time [s], standard deviation per axis [rad].
double driftUntil(double time, const geometry::Rig& rig);

/// The rig with its covariance widened by what cameras may have done from solved_at to a time [s].
geometry::Rig withDrift(geometry::Rig rig, double time);

/// Whether the cameras' poses differ by no more than the rig's covariance and the most that cameras
/// drift explain: chi-squared of all poses together, 99.9 %.
bool isWithinDrift(const geometry::Rig& rig, const geometry::Rig& adjusted);

/// The rig with the latest epochs of the clocks, and its covariance widened by what clocks may have
/// done: known ones against each other only, since the images show none of what all do together.
geometry::Rig withClockPrior(geometry::Rig rig, const KeyframeSource& source);

/// Gauge of the clocks of a rig that was adjusted with withClockPrior(): the time offsets that were
/// known have not changed, in the median. The covariance is that against the clocks' mean. What all
/// clocks do together moves no point, and no image shows it; only errors of the views' velocities
/// seem to. Where correlations are left out, as in copyClock(), it would count as an error of each
/// clock. Of all references the mean gives the clocks the least variances (S-transformation, Baarda
/// 1973).
/// @param before the rig that was adjusted.
void holdTime(const geometry::Rig& before, const KeyframeSource& source, geometry::Rig* adjusted);

/// Copies a camera's time offset and its variance, without its correlations.
void copyClock(const geometry::Rig& from, std::size_t camera, geometry::Rig* to);

/// The rig with the time offsets of an adjusted one. @param only_new of cameras that reconnected.
geometry::Rig withClocks(const geometry::Rig& adjusted, geometry::Rig rig, bool only_new = false);

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

/// A proposal whose rig says in its verdict what has changed, and when that was checked.
/// @param before the rig in use. @param checked the images that the rig was checked with.
Proposal dated(Proposal proposal,
               const geometry::Rig& before,
               const std::vector<capture::Image>& checked);

/// Proposes a rig that adjustRig() made, if it explains later images better than the rig before:
/// with the poses of that one where the adjusted clocks explain nearly as much.
/// @returns nothing when it explains too little more, when too few places were seen, when a camera
/// does not fit the others or reconnected since, or when poses differ by more than drift.
std::optional<Proposal> proposeAdjustment(const geometry::Rig& before,
                                          const geometry::Rig& adjusted,
                                          const std::vector<capture::Image>& later);

/// The angle between the attitudes of a camera [rad].
double turnOf(const geometry::RigCamera& a, const geometry::RigCamera& b);

}  // namespace wiimote_tracker::continuous
