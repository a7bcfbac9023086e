#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_RIG_CLOCKS_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_RIG_CLOCKS_H

#include "continuous/keyframes.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>

namespace wiimote_tracker::continuous {

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

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_RIG_CLOCKS_H
