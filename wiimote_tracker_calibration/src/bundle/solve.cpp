#include "wiimote_tracker_calibration/bundle/solve.h"

#include "checks.h"
#include "start.h"

#include <algorithm>

namespace wiimote_tracker::bundle {

Reconstruction solve(const std::vector<geometry::Camera>& cameras,
                     const std::vector<Observation>& observations,
                     std::size_t point_count,
                     const Options& options) {
  Reconstruction reconstruction;
  reconstruction.cameras = cameras;
  reconstruction.points.resize(point_count);
  reconstruction.observations = observations;
  checkObservations(reconstruction, options);

  const NormalizedViews views = normalize(reconstruction);
  std::vector<bool> placed(cameras.size(), false);
  startFromPair(views, options, &reconstruction, &placed);
  const auto settle = [&] {
    // A camera that was just placed is off by more than its noise; the points then bring it in.
    const double kRough = 4.0;
    triangulatePoints(&reconstruction, placed, kRough * options.maximum_error,
                      options.minimum_angle);
    adjust(&reconstruction, options, Held());
  };
  settle();
  while (std::find(placed.begin(), placed.end(), false) != placed.end()) {
    placeNext(views, options, &reconstruction, &placed);
    settle();
  }
  refuseUnexplained(reconstruction, options);
  return reconstruction;
}

}  // namespace wiimote_tracker::bundle
