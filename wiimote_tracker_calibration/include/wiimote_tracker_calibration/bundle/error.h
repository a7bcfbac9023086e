#ifndef WIIMOTE_TRACKER_CALIBRATION_BUNDLE_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_BUNDLE_ERROR_H

#include <wiimote_tracker_msgs/error.h>

namespace wiimote_tracker::bundle {

/// The observations do not determine the cameras. what() is one sentence that says what to do.
struct BundleError : Error {
  using Error::Error;
};

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_BUNDLE_ERROR_H
