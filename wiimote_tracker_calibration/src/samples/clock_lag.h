#pragma once

#include "wiimote_tracker_calibration/wave/recording.h"

#include <cstddef>
#include <optional>

namespace wiimote_tracker::samples {

/// How late a camera's stamps are against the others' [s], to 0.02 s, at most 3 s: the maximum of
/// the cross-correlation of the spots' speeds, which depend little on where a camera stands.
/// Nothing without a clear maximum.
std::optional<double> clockLag(const wave::Recording& recording, std::size_t camera);

}  // namespace wiimote_tracker::samples
