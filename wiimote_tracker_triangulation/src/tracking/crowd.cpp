#include "crowd.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

bool isInCrowd(const Track& track,
               const CameraStates& states,
               const std::vector<TrackerCamera>& cameras,
               const TrackerOptions& options,
               double time) {
  constexpr double kOldest = 0.2;  // more than between two images, if some are lost [s]
  const Eigen::Vector3d position = track.approximatePosition(time);
  std::size_t count = 0;
  bool is_crowded_out = false;
  for (const auto& [camera, state] : states) {
    const NewestImage& view = state.newest;
    if (!view.full || view.time < time - kOldest)
      continue;
    // No spot of it now, nor within tracked_time: a false detection hides an LED in one image only.
    const bool is_hidden =
        track.lastDetectedBy(camera) < std::min(view.time, time - options.tracked_time);
    if (!(is_hidden || view.has_unknown) || !cameras[camera].forRays().sees(position))
      continue;
    ++count;
    is_crowded_out = is_crowded_out || (is_hidden && view.has_unknown);
  }
  return count >= 2 && is_crowded_out;
}

}  // namespace wiimote_tracker::tracking
