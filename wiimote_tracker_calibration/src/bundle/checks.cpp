#include "steps.h"

#include "start.h"

#include "adjust/opencv.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::bundle {

void checkObservations(const Reconstruction& reconstruction) {
  if (reconstruction.cameras.size() < 2)
    throw BundleError("give two cameras or more: one alone does not determine depth");
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

bool isOnALine(const Reconstruction& reconstruction) {
  const NormalizedViews views = normalize(reconstruction);
  return std::none_of(views.begin(), views.end(), [](const auto& view) {
    std::vector<cv::Point2d> places;
    places.reserve(view.size());
    for (const auto& [point, place] : view)
      places.emplace_back(place.x(), place.y());
    return adjust::fillAnArea(places);
  });
}

bool isFlat(const Reconstruction& solution, const Options& options, double slack) {
  const double kErrors = 3.0;
  const double error = kErrors * statistics(solution).rms;
  const NormalizedViews views = normalize(solution);
  bool any = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const CommonViews common = commonViews(views[i], views[j]);
      if (common.first.size() < options.minimum_common_points)
        continue;
      any = true;
      const geometry::Intrinsics& lens = solution.cameras[j].intrinsics;
      const double distance = distanceFromPlane(common, options.maximum_error / lens.fx) * lens.fx;
      if (distance > std::max(error, slack * lens.width))
        return false;
    }
  }
  return any;
}

std::optional<std::string> suspicion(const Reconstruction& observed,
                                     bool intrinsics_given,
                                     const std::function<bool(const Reconstruction&)>& works) {
  const std::size_t count = observed.cameras.size();
  for (std::size_t camera = 0; camera < count; ++camera) {
    Reconstruction mirrored = observed;
    for (Observation& observation : mirrored.observations) {
      if (observation.camera == camera)
        observation.pixel.x() =
            2.0 * observed.cameras[camera].intrinsics.cx - observation.pixel.x();
    }
    if (works(mirrored))
      return "the image of " + observed.cameras[camera].name +
             " is mirrored against the others: make its x run to the right and its y down";
  }
  for (std::size_t i = 0; intrinsics_given && i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      Reconstruction exchanged = observed;
      std::swap(exchanged.cameras[i].intrinsics, exchanged.cameras[j].intrinsics);
      if (works(exchanged))
        return "the intrinsics of " + observed.cameras[i].name + " and " +
               observed.cameras[j].name + " are crossed: exchange them, or the names";
    }
  }
  return std::nullopt;
}

}  // namespace wiimote_tracker::bundle
