#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_SUSPICION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_SUSPICION_H

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <functional>
#include <optional>
#include <string>

namespace wiimote_tracker::bundle {

/// Observations that nothing explains: what makes them explicable, as a sentence. Tried are one
/// camera's image mirrored, and, with given intrinsics, those of two cameras exchanged.
/// @param works whether observations changed in this way can be explained.
std::optional<std::string> suspicion(const Reconstruction& observed,
                                     bool intrinsics_given,
                                     const std::function<bool(const Reconstruction&)>& works);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_SUSPICION_H
