#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_STORED_IMAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_STORED_IMAGE_H

#include "association/assign_spots.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {

/// An image in the history, with as many spots as one assignment takes.
struct StoredImage {
  std::size_t camera = 0;      // in the rig
  double time = 0.0;           // of the exposure, in the rig's time [s]
  double arrival = 0.0;        // [s]
  double stamp_stddev = 0.0;   // with that of the clock's offset [s]
  std::uint32_t clocks = 0;    // version of the clocks' corrections in the time
  bool full = false;           // as many spots as the camera can report: more LEDs may be visible
  std::uint64_t number = 0;    // counts all images in the order of add()
  std::size_t spot_count = 0;  // usable spots, which come first; then the masked ones
  boost::container::static_vector<Eigen::Vector2d, association::kMaximumSpots> pixels;
  LedFit bodies;  // see CameraImage

  /// The order in which images update the tracks, whatever the order of their arrival.
  bool operator<(const StoredImage& other) const {
    return time != other.time ? time < other.time : camera < other.camera;
  }
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_STORED_IMAGE_H
