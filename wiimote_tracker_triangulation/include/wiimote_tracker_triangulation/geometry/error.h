#pragma once

#include <wiimote_tracker_msgs/error.h>

namespace wiimote_tracker::geometry {

using wiimote_tracker::Error;
using wiimote_tracker::FileError;

/// A camera, rig or file holds values that cannot be used.
struct InvalidRigError : Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::geometry
