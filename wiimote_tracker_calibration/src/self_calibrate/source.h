#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SELF_CALIBRATE_SOURCE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SELF_CALIBRATE_SOURCE_H

#include "wiimote_tracker_calibration/import/recording.h"

#include <string>
#include <vector>

namespace wiimote_tracker::import {

/// Reads `<camera>/ir_blobs` of a bag. Cameras that are not synchronised are brought to common
/// instants, the times of the images of the camera that has most of them: between two images no
/// more than 50 ms apart, each with exactly one spot, its place is interpolated linearly. Stamps
/// are taken as they are.
/// @throws ImportError: no bag, fewer than two cameras, images whose size changes.
Recording readBag(const std::string& path);

/// The cameras named, in the order of the recording. @throws ImportError for a name that is none.
Recording subsetOf(const Recording& recording, const std::vector<std::string>& names);

/// Gives every camera its intrinsics of a rig file (by name) or of the basenameN.rad of a folder in
/// the layout of a recording (by number). @throws ImportError: a camera is missing there, or has
/// another image size; geometry::Error as readRigFile.
void takeIntrinsics(const std::string& path, Recording* recording);

}  // namespace wiimote_tracker::import

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SELF_CALIBRATE_SOURCE_H
