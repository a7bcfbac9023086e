#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_ERROR_H

#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker::identity {

/// Blink codes or a file of them cannot be used. what() is one sentence: why, and what to do.
struct IdentityError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_ERROR_H
