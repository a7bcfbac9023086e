#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_ERROR_H

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::square {

/// A square cannot be solved. what() is one sentence: why, and what to do.
struct SquareError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_ERROR_H
