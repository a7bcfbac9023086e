#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ERROR_H

#include <stdexcept>

namespace wiimote_tracker::geometry {

/// Base of everything the geometry core throws. what() is one sentence that says what to do.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A camera, rig or file holds values that cannot be used.
struct InvalidRigError : Error {
  using Error::Error;
};

/// A rig file is missing, unreadable, damaged, of a foreign kind or version, or cannot be written.
struct RigFileError : Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ERROR_H
