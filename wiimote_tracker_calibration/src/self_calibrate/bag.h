#pragma once

#include "wiimote_tracker_calibration/import/recording.h"

#include <string>

namespace wiimote_tracker::self_calibrate {

/// Reads `<camera>/ir_blobs` of a bag. Pixels are interpolated linearly to the times of the camera
/// with the most images, between images at most 50 ms apart with exactly one spot each. Stamps are
/// not corrected.
/// @throws import::ImportError: no bag, fewer than two cameras, images whose size changes.
import::Recording readBag(const std::string& path);

}  // namespace wiimote_tracker::self_calibrate
