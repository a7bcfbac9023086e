#ifndef WIIMOTE_TRACKER_CALIBRATION_RECALIBRATE_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_RECALIBRATE_ERROR_H

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::recalibrate {

/// A camera cannot be solved against the others. what() is one sentence: why, and what to do.
struct RecalibrateError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::recalibrate

#endif  // WIIMOTE_TRACKER_CALIBRATION_RECALIBRATE_ERROR_H
