#ifndef WIIMOTE_TRACKER_TRIANGULATION_REMAP_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_REMAP_ERROR_H

#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker::remap {

/// A correction of the volume cannot be fitted, or not be used. what() is one sentence: why, and
/// what to do.
struct RemapError : geometry::Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_TRIANGULATION_REMAP_ERROR_H
