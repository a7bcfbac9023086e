#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::bundle {

namespace {

double medianOf(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half),
                   values.end());
  if (values.size() % 2 == 1)
    return values[half];
  const double below =
      *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half));
  return 0.5 * (below + values[half]);
}

template <typename Wanted>
Statistics over(const Reconstruction& reconstruction, const Wanted& wanted) {
  Statistics result;
  std::vector<double> errors;
  double sum = 0.0;
  double squares = 0.0;
  double squares_m = 0.0;
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    if (!wanted(observation))
      continue;
    ++result.observations;
    const auto error = reprojectionError(reconstruction, observation);
    if (!reconstruction.inliers[i] || !error)
      continue;
    const geometry::Camera& camera = reconstruction.cameras[observation.camera];
    const double depth =
        (camera.world_from_camera.inverse() * *reconstruction.points[observation.point]).z();
    const double focal_length = 0.5 * (camera.intrinsics.fx + camera.intrinsics.fy);
    errors.push_back(*error);
    sum += *error;
    squares += *error * *error;
    squares_m += std::pow(*error * depth / focal_length, 2);
  }
  result.inliers = errors.size();
  if (errors.empty())
    return result;
  const auto count = static_cast<double>(errors.size());
  result.rms = std::sqrt(squares / count);
  result.mean = sum / count;
  result.median = medianOf(errors);
  result.rms_m = std::sqrt(squares_m / count);
  return result;
}

}  // namespace

Statistics statistics(const Reconstruction& reconstruction) {
  return over(reconstruction, [](const Observation&) { return true; });
}

Statistics statistics(const Reconstruction& reconstruction, std::size_t camera) {
  return over(reconstruction, [camera](const Observation& o) { return o.camera == camera; });
}

}  // namespace wiimote_tracker::bundle
