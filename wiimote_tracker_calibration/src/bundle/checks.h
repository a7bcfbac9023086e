#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CHECKS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CHECKS_H

#include "wiimote_tracker_calibration/bundle/solve.h"

#include <functional>
#include <optional>
#include <string>

namespace wiimote_tracker::bundle {

/// @throws BundleError: invalid observations, fewer than two cameras.
void checkObservations(const Reconstruction& reconstruction);

/// @throws BundleError if most observations of some camera are outliers.
void refuseUnexplained(const Reconstruction& reconstruction, const Options& options);

/// Whether the observations of each camera lie on a line in its image.
bool isOnALine(const Reconstruction& reconstruction);

/// Whether the solution's depth is not determined, since the light moved in a plane or all cameras
/// stand in one place: a homography explains the views of any two cameras to 3 times the solution's
/// error, or to `slack` [image widths].
bool isFlat(const Reconstruction& solution, const Options& options, double slack);

/// Looks for the cause if no solution fits: one camera's image is mirrored, or the given intrinsics
/// of two cameras are exchanged. @param works whether a solution fits the changed observations.
/// @returns a sentence, or nothing if neither helps.
std::optional<std::string> suspicion(const Reconstruction& observed,
                                     bool intrinsics_given,
                                     const std::function<bool(const Reconstruction&)>& works);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CHECKS_H
