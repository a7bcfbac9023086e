#ifndef WIIMOTE_TRACKER_CALIBRATION_REMAP_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_REMAP_ERROR_H

#include <wiimote_tracker_msgs/error.h>

namespace wiimote_tracker::remap {

/// The progress callback asked to stop.
struct Cancelled : Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_REMAP_ERROR_H
