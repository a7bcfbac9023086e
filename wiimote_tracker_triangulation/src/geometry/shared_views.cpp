#include "wiimote_tracker_triangulation/geometry/shared_views.h"

#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <algorithm>

namespace wiimote_tracker::geometry {
namespace {

/// A grid of points in a camera's view: pixels, at distances that grow by a constant factor.
std::vector<Eigen::Vector3d> pointsInView(const Camera& camera, double range) {
  constexpr int kColumns = 12;
  constexpr int kRows = 9;
  constexpr double kGrowth = 1.25;  // ratio of successive distances
  constexpr double kNearest = 0.2;  // [m]
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row <= kRows; ++row) {
    for (int column = 0; column <= kColumns; ++column) {
      const Eigen::Vector2d pixel((camera.intrinsics.width - 1.0) * column / kColumns,
                                  (camera.intrinsics.height - 1.0) * row / kRows);
      const auto sight = sightFromPixel(camera, pixel);
      if (!sight)
        continue;
      for (double distance = range; distance >= std::min(kNearest, range); distance /= kGrowth)
        points.push_back(sight->origin + distance * sight->direction);
    }
  }
  return points;
}

bool seesAny(const Camera& camera, const std::vector<Eigen::Vector3d>& points, double range) {
  return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    return (point - camera.center()).squaredNorm() <= range * range && camera.sees(point);
  });
}

}  // namespace

std::vector<std::vector<std::size_t>> sharedViews(const Rig& rig, double range) {
  const std::vector<Camera> cameras = rig.rayCameras();
  const std::size_t count = cameras.size();
  std::vector<std::vector<Eigen::Vector3d>> points;
  for (const Camera& camera : cameras)
    points.push_back(pointsInView(camera, range));
  std::vector<std::vector<std::size_t>> shared(count);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      const bool near = (cameras[a].center() - cameras[b].center()).norm() <= 2.0 * range;
      if (!near ||
          (!seesAny(cameras[b], points[a], range) && !seesAny(cameras[a], points[b], range)))
        continue;
      shared[a].push_back(b);
      shared[b].push_back(a);
    }
  }
  return shared;
}

std::vector<std::vector<std::size_t>> groupsOf(
    const std::vector<std::vector<std::size_t>>& partners) {
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> taken(partners.size());
  for (std::size_t first = 0; first < partners.size(); ++first) {
    if (taken[first])
      continue;
    std::vector<std::size_t> group = {first};
    taken[first] = true;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const std::size_t partner : partners[group[i]]) {
        if (!taken[partner])
          group.push_back(partner);
        taken[partner] = true;
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(group);
  }
  return groups;
}

}  // namespace wiimote_tracker::geometry
