#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_ERROR_H

#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker::measurements {

/// A file of measurements cannot be written. what() is one sentence that says what to do.
struct WriteError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_ERROR_H
