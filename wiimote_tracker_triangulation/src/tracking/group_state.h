#pragma once

#include "association/assign_spots.h"
#include "camera_fit.h"
#include "crowd.h"
#include "ids.h"
#include "merged_pair.h"
#include "offset_regression.h"
#include "track.h"
#include "tracker_camera.h"
#include "tracking/timed_image.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>
#include <boost/container/flat_map.hpp>
#include <boost/container/static_vector.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace wiimote_tracker::tracking {

/// An image in the history, with as many spots as one assignment takes.
struct StoredImage : TimedImage {
  std::uint32_t clocks = 0;    // version of the clocks' corrections in the time
  bool full = false;           // as many spots as the camera can report: more LEDs may be visible
  std::uint64_t number = 0;    // counts all images in the order of add()
  std::size_t spot_count = 0;  // usable spots, which come first; then the masked ones
  boost::container::static_vector<Eigen::Vector2d, association::kMaximumSpots> pixels;
  LedFit bodies;  // see CameraImage
};

/// The spots of a camera's newest image that are assigned to no track and have a ray.
struct UnassignedSpots {
  struct Spot {
    Eigen::Vector2d pixel;
    SpotKey key;
  };

  double time = -1e300;       // [s]
  double since = 0.0;         // first image of the latest ones that all have some [s]
  double stamp_stddev = 0.0;  // StoredImage::stamp_stddev
  bool full = false;          // StoredImage::full
  boost::container::static_vector<Spot, association::kMaximumSpots> spots;
  boost::container::static_vector<geometry::Sight, association::kMaximumSpots> sights;  // theirs
};

/// What a late image may change of one camera.
struct CameraState {
  CameraFit fit;
  OffsetRegression offset_regression;  // since the last correction
  UnassignedSpots unassigned;
  NewestImage newest;
};

/// Of the cameras of a group, by their indices in the rig. Boost's own allocator does not align
/// Eigen's vectors where AVX needs it.
using CameraStates =
    boost::container::flat_map<std::size_t,
                               CameraState,
                               std::less<std::size_t>,
                               std::allocator<std::pair<std::size_t, CameraState>>>;

/// What is the same for all images of a group.
struct GroupSetup {
  const geometry::Rig& rig;
  const std::vector<TrackerCamera>& cameras;  // of the rig
  const TrackerOptions& options;
};

/// Everything of a group of cameras that a late image may change.
struct GroupState {
  std::vector<Track> tracks;
  std::vector<MergedPair> pairs;
  CameraStates cameras;
  std::uint32_t clocks = 0;  // version of the corrections of their clocks
};

}  // namespace wiimote_tracker::tracking
