#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_SUSPICION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_SUSPICION_H

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <functional>
#include <optional>
#include <string>

namespace wiimote_tracker::bundle {

/// Looks for the cause if no solution fits: one camera's image is mirrored, or the given intrinsics
/// of two cameras are exchanged. @param works whether a solution fits the changed observations.
/// @returns a sentence, or nothing if neither helps.
std::optional<std::string> suspicion(const Reconstruction& observed,
                                     bool intrinsics_given,
                                     const std::function<bool(const Reconstruction&)>& works);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_SUSPICION_H
