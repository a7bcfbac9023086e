#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_ERROR_H

#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker::gesture {

/// An example or a file of gestures cannot be used. what() is one sentence: why, and what to do.
struct GestureError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_ERROR_H
