#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SELF_CALIBRATE_SOURCE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SELF_CALIBRATE_SOURCE_H

#include "wiimote_tracker_calibration/import/number_table.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <string>
#include <vector>

namespace wiimote_tracker::self_calibrate {

using import::ImportError;
using import::Pixels;
using import::RecordedCamera;
using import::Recording;

/// Reads `<camera>/ir_blobs` of a bag. Pixels are interpolated linearly to the times of the camera
/// with the most images, between images at most 50 ms apart with exactly one spot each. Stamps are
/// not corrected.
/// @throws ImportError: no bag, fewer than two cameras, images whose size changes.
Recording readBag(const std::string& path);

/// The named cameras, in the order of the recording. @throws ImportError for an unknown name.
Recording subsetOf(const Recording& recording, const std::vector<std::string>& names);

/// Takes the intrinsics of all cameras, by name, from a rig file or from the folder of a recording.
/// @throws ImportError: a camera is missing there, or has another image size; Error as
/// readRigFile().
void takeIntrinsics(const std::string& path, Recording* recording);

}  // namespace wiimote_tracker::self_calibrate

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SELF_CALIBRATE_SOURCE_H
