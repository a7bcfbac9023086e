#include "wiimote_tracker_calibration/bundle/solve.h"

#include "wiimote_tracker_calibration/bundle/error.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include "start.h"

#include <algorithm>
#include <string>

namespace wiimote_tracker::bundle {

namespace {

void check(const Reconstruction& reconstruction, const Options& options) {
  if (reconstruction.cameras.size() < 2)
    throw BundleError("give two cameras or more: one alone cannot tell depth");
  if (!(options.maximum_error > 0.0) || !(options.loss_scale > 0.0) ||
      options.minimum_common_points < 8)
    throw BundleError(
        "maximum_error and loss_scale must be above 0, minimum_common_points 8 or more");
  for (const geometry::Camera& camera : reconstruction.cameras) {
    try {
      camera.intrinsics.check();
    } catch (const geometry::Error& error) {
      throw BundleError(camera.name + ": " + error.what());
    }
  }
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    const std::string which = "observation " + std::to_string(i);
    if (observation.camera >= reconstruction.cameras.size())
      throw BundleError(which + " names camera " + std::to_string(observation.camera) +
                        ", which does not exist");
    if (observation.point >= reconstruction.points.size())
      throw BundleError(which + " names point " + std::to_string(observation.point) +
                        ", which does not exist");
    if (!observation.pixel.allFinite())
      throw BundleError(which + " is not finite: leave out what a camera did not see");
  }
}

/// A solution that leaves many observations unexplained is none.
void refuseUnexplained(const Reconstruction& reconstruction, const Options& options) {
  std::vector<std::size_t> views(reconstruction.points.size(), 0);
  for (const Observation& observation : reconstruction.observations)
    ++views[observation.point];
  std::vector<std::size_t> all(reconstruction.cameras.size(), 0);
  std::vector<std::size_t> inliers(reconstruction.cameras.size(), 0);
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    if (views[observation.point] < 2)
      continue;
    ++all[observation.camera];
    if (reconstruction.inliers[i])
      ++inliers[observation.camera];
  }
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    if (inliers[i] < options.minimum_common_points || 2 * inliers[i] < all[i])
      throw BundleError("only " + std::to_string(inliers[i]) + " of " + std::to_string(all[i]) +
                        " observations of " + reconstruction.cameras[i].name +
                        " fit to the other cameras: check its intrinsics and its frame numbers");
  }
}

}  // namespace

Reconstruction solve(const std::vector<geometry::Camera>& cameras,
                     const std::vector<Observation>& observations,
                     std::size_t point_count,
                     const Options& options) {
  Reconstruction reconstruction;
  reconstruction.cameras = cameras;
  reconstruction.points.resize(point_count);
  reconstruction.observations = observations;
  check(reconstruction, options);

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
