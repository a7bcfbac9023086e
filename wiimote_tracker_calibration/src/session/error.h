#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_ERROR_H

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::session {

/// A session cannot be solved or stored, or rigs cannot be joined. what() is one sentence: why, and
/// what to do.
struct SessionError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_ERROR_H
