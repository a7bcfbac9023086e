#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_ERROR_H

#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker::body {

/// A body or a file of bodies cannot be used. what() is one sentence: why, and what to do.
struct BodyError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_ERROR_H
