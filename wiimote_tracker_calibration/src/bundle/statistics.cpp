#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace wiimote_tracker::bundle {

namespace {

/// Quantile of sorted values, interpolated; NaN when there are none.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Statistics statisticsOf(std::vector<double> errors) {
  Statistics result;
  result.observations = errors.size();
  errors.erase(std::remove_if(errors.begin(), errors.end(),
                              [](double error) { return !std::isfinite(error); }),
               errors.end());
  std::sort(errors.begin(), errors.end());
  result.inliers = errors.size();
  const auto count = static_cast<double>(errors.size());
  result.rms =
      std::sqrt(std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) / count);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  result.median = quantile(errors, 0.5);
  result.p95 = quantile(errors, 0.95);
  return result;
}

Statistics statistics(const Reconstruction& reconstruction, std::optional<std::size_t> camera) {
  std::vector<double> errors;
  double squares_m = 0.0;
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    if (camera && observation.camera != *camera)
      continue;
    const auto error = reprojectionError(reconstruction, observation);
    errors.push_back(kOutlier);
    if (!reconstruction.inliers[i] || !error)
      continue;
    errors.back() = *error;
    const geometry::Camera& seeing = reconstruction.cameras[observation.camera];
    const double depth =
        (seeing.world_from_camera.inverse() * *reconstruction.points[observation.point]).z();
    const double focal_length = 0.5 * (seeing.intrinsics.fx + seeing.intrinsics.fy);
    squares_m += std::pow(*error * depth / focal_length, 2);
  }
  Statistics result = statisticsOf(errors);
  if (result.inliers > 0)
    result.rms_m = std::sqrt(squares_m / static_cast<double>(result.inliers));
  return result;
}

std::vector<Statistics> statisticsOfCameras(const Reconstruction& reconstruction) {
  std::vector<Statistics> result;
  for (std::size_t i = 0; i < reconstruction.cameras.size(); ++i)
    result.push_back(statistics(reconstruction, i));
  return result;
}

geometry::Rig rigOf(const Reconstruction& reconstruction, double factor) {
  geometry::Rig rig;
  for (const Statistics& errors : statisticsOfCameras(reconstruction)) {
    geometry::RigCamera camera;
    camera.camera = reconstruction.cameras[rig.cameras.size()];
    camera.residual_px = factor * errors.rms;
    camera.residual_m = factor * errors.rms_m;
    camera.observations = static_cast<std::uint32_t>(errors.observations);
    camera.inliers = static_cast<std::uint32_t>(errors.inliers);
    rig.cameras.push_back(camera);
  }
  return rig;
}

}  // namespace wiimote_tracker::bundle
