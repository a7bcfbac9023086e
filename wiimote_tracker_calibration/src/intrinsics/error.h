#ifndef WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_ERROR_H

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::intrinsics {

/// Views of the board do not determine the lens.
struct IntrinsicsError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::intrinsics

#endif  // WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_ERROR_H
