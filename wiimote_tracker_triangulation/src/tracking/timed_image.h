#pragma once

#include <cstddef>

namespace wiimote_tracker::tracking {

/// When a camera's image was exposed and when it arrived.
struct TimedImage {
  std::size_t camera = 0;     // in the rig
  double time = 0.0;          // of the exposure, in the rig's time [s]
  double arrival = 0.0;       // [s]
  double stamp_stddev = 0.0;  // with that of the clock's offset [s]

  /// The order in which images are used, whatever the order of their arrival.
  bool operator<(const TimedImage& other) const {
    return time != other.time ? time < other.time : camera < other.camera;
  }
};

}  // namespace wiimote_tracker::tracking
