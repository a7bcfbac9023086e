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
  while (true) {
    // A camera that was just placed is off by more than its noise.
    const double kTolerance = 4.0;
    triangulatePoints(&reconstruction, placed, kTolerance * options.maximum_error,
                      options.minimum_angle);
    const bool all_placed = std::find(placed.begin(), placed.end(), false) == placed.end();
    Options now = options;
    now.rough = options.rough || !all_placed;
    adjust(&reconstruction, now, Held());
    if (all_placed)
      break;
    placeNext(views, options, &reconstruction, &placed);
  }
  refuseUnexplained(reconstruction, options);
  return reconstruction;
}

}  // namespace wiimote_tracker::bundle
