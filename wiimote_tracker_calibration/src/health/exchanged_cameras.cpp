#include "exchanged_cameras.h"

#include "drift_residuals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace wiimote_tracker::health {

namespace {

using CameraPair = std::pair<std::size_t, std::size_t>;

// By how much less the residuals must scatter than as they are, and than with any other two
// cameras. Remotes do not stand exactly where the other one stood.
constexpr double kBetter = 4.0;
constexpr double kUnique = 2.0;
// Cameras whose residuals scatter by less than this share of the worst are not tried.
constexpr double kSuspect = 0.5;

/// A sight after its camera was moved.
void move(const Eigen::Isometry3d& motion, geometry::Sight* sight) {
  sight->origin = motion * sight->origin;
  sight->direction = motion.linear() * sight->direction;
  sight->axis = motion.linear() * sight->axis;
  sight->pixel_by_offset = sight->pixel_by_offset * motion.linear().transpose();
}

/// The samples if each of two cameras stood where the other one was calibrated.
DriftSamples exchanged(const geometry::Rig& rig,
                       std::size_t a,
                       std::size_t b,
                       DriftSamples samples) {
  const Eigen::Isometry3d from_a_to_b =
      rig.cameras[b].camera.world_from_camera * rig.cameras[a].camera.world_from_camera.inverse();
  for (DriftSample& sample : samples) {
    for (auto& [camera, sight] : sample.sights) {
      if (camera == a || camera == b)
        move(camera == a ? from_a_to_b : from_a_to_b.inverse(), &sight);
    }
  }
  return samples;
}

/// Per camera the standard deviation of its residuals against all others [px]; nothing: too few
/// samples.
std::vector<std::optional<double>> scattersOf(const geometry::Rig& rig,
                                              const DriftSamples& samples) {
  const std::vector<bool> all(rig.cameras.size(), true);
  std::vector<std::optional<double>> scatters(rig.cameras.size());
  for (std::size_t i = 0; i < scatters.size(); ++i) {
    if (const auto drift = driftOf(i, rig, samples, all, 1.0))
      scatters[i] = drift->scatter;
  }
  return scatters;
}

double largestOf(const std::vector<std::optional<double>>& scatters) {
  return std::max_element(scatters.begin(), scatters.end())->value_or(0.0);
}

}  // namespace

std::optional<CameraPair> exchangedCameras(const geometry::Rig& rig, const DriftSamples& samples) {
  geometry::Rig exact = rig;
  exact.covariance.resize(0, 0);  // a scatter needs neither it nor derivatives
  const std::size_t count = rig.cameras.size();
  const auto as_is = scattersOf(exact, samples);
  const double worst = largestOf(as_is);
  std::vector<std::pair<double, CameraPair>> found;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      if (std::min(as_is[a], as_is[b]).value_or(0.0) < kSuspect * worst)
        continue;
      const auto scatters = scattersOf(exact, exchanged(rig, a, b, samples));
      if (scatters[a] && scatters[b])
        found.emplace_back(largestOf(scatters), CameraPair(a, b));
    }
  }
  std::sort(found.begin(), found.end());
  if (found.empty() || found[0].first > worst / kBetter ||
      (found.size() > 1 && found[1].first < kUnique * found[0].first))
    return std::nullopt;
  return found[0].second;
}

}  // namespace wiimote_tracker::health
