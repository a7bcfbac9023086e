#ifndef WIIMOTE_TRACKER_CALIBRATION_REMAP_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_REMAP_ERROR_H

#include <wiimote_tracker_triangulation/remap/error.h>

namespace wiimote_tracker::remap {

/// The progress callback asked to stop.
struct Cancelled : RemapError {
  using RemapError::RemapError;
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_REMAP_ERROR_H
