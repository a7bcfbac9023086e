#ifndef WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_SAMPLES_FILE_H
#define WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_SAMPLES_FILE_H

#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <string>

namespace wiimote_tracker::intrinsics {

/// Writes samples as YAML: to a new file that is then renamed, so that a reader never sees half a
/// file. Numbers are written so that they come back bit for bit.
/// @throws SamplesFileError: cannot be written; then the old file is as it was.
void writeSamplesFile(const Samples& samples, const std::string& path);

/// @throws SamplesFileError: missing, unreadable, damaged, foreign, of an unknown version, or with
/// values out of range.
Samples readSamplesFile(const std::string& path);

}  // namespace wiimote_tracker::intrinsics

#endif  // WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_SAMPLES_FILE_H
