#ifndef WIIMOTE_TRACKER_CALIBRATION_PLACE_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_PLACE_ERROR_H

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::place {

/// A place cannot be measured. what() is one sentence: why, and what to do.
struct PlaceError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::place

#endif  // WIIMOTE_TRACKER_CALIBRATION_PLACE_ERROR_H
