#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H

#include "stored_image.h"
#include "track.h"
#include "tracker_camera.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <boost/container/flat_map.hpp>

#include <cstddef>
#include <limits>
#include <vector>

namespace wiimote_tracker::tracking {

/// More lights than the cameras of a group can report. An LED that they do not report has no track,
/// but it may be merged with one that has: the spot is then between both, at most half of
/// merging_distance from either. Residuals do not always show that, nor does a third camera, which
/// may face another one.
class Crowd {
 public:
  /// Notes an image. @param has_unknown whether it shows a light of no confirmed LED
  void add(const StoredImage& image, bool has_unknown);

  /// Whether a full camera shows an unknown light instead of a track's LED in its view, and another
  /// one shows an unknown light or not the LED. What one camera alone shows may be a lamp, or the
  /// camera was moved.
  bool mayHideLedsNear(const Track& track,
                       const std::vector<TrackerCamera>& cameras,
                       const TrackerOptions& options,
                       double time) const;

 private:
  /// A camera's newest image.
  struct View {
    double time = -std::numeric_limits<double>::infinity();  // [s]
    bool full = false;
    bool has_unknown = false;
  };

  boost::container::flat_map<std::size_t, View> views_;  // by camera
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H
