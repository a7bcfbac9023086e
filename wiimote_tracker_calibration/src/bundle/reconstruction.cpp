#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include "wiimote_tracker_triangulation/geometry/triangulate.h"

namespace wiimote_tracker::bundle {

namespace {

using Views = std::vector<std::size_t>;  // indices of observations of one point

struct Consensus {
  Eigen::Vector3d point;
  Views inliers;
  double squared_error = 0.0;  // of the inliers
};

std::optional<double> errorOf(const geometry::Camera& camera,
                              const Eigen::Vector3d& point,
                              const Eigen::Vector2d& pixel) {
  const auto projected = camera.project(point);
  if (!projected)
    return std::nullopt;
  return (*projected - pixel).norm();
}

class PointSolver {
 public:
  PointSolver(const Reconstruction& reconstruction, double maximum_error)
      : reconstruction_(reconstruction), maximum_error_(maximum_error) {}

  /// The point of all views if they agree, else of the largest group that agrees with a pair of
  /// views.
  std::optional<Consensus> solve(const Views& views) const {
    std::optional<Consensus> best = from(views, views);
    if (best && best->inliers.size() == views.size())
      return best;
    best.reset();
    for (std::size_t i = 0; i < views.size(); ++i) {
      for (std::size_t j = i + 1; j < views.size(); ++j) {
        std::optional<Consensus> candidate = from({views[i], views[j]}, views);
        if (!candidate || candidate->inliers.size() < 2)
          continue;
        const std::optional<Consensus> refined = from(candidate->inliers, views);
        if (refined && refined->inliers.size() >= candidate->inliers.size())
          candidate = refined;
        if (!best || isBetter(*candidate, *best))
          best = candidate;
      }
    }
    return best;
  }

 private:
  static bool isBetter(const Consensus& a, const Consensus& b) {
    if (a.inliers.size() != b.inliers.size())
      return a.inliers.size() > b.inliers.size();
    return a.squared_error < b.squared_error;
  }

  /// The point of the `chosen` views, and its inliers among all `views`.
  std::optional<Consensus> from(const Views& chosen, const Views& views) const {
    std::vector<geometry::Observation> rays;
    for (const std::size_t view : chosen) {
      const Observation& observation = reconstruction_.observations[view];
      rays.push_back({&reconstruction_.cameras[observation.camera], observation.pixel});
    }
    const auto triangulated = geometry::triangulate(rays, geometry::TriangulationOptions());
    if (!triangulated)
      return std::nullopt;
    Consensus consensus;
    consensus.point = triangulated->position;
    for (const std::size_t view : views) {
      const Observation& observation = reconstruction_.observations[view];
      const auto error =
          errorOf(reconstruction_.cameras[observation.camera], consensus.point, observation.pixel);
      if (error && *error <= maximum_error_) {
        consensus.inliers.push_back(view);
        consensus.squared_error += *error * *error;
      }
    }
    return consensus;
  }

  const Reconstruction& reconstruction_;
  double maximum_error_;
};

}  // namespace

std::optional<double> reprojectionError(const Reconstruction& reconstruction,
                                        const Observation& observation) {
  const auto& point = reconstruction.points[observation.point];
  if (!point)
    return std::nullopt;
  return errorOf(reconstruction.cameras[observation.camera], *point, observation.pixel);
}

void triangulatePoints(Reconstruction* reconstruction,
                       double maximum_error,
                       const std::vector<bool>& usable) {
  std::vector<Views> views(reconstruction->points.size());
  for (std::size_t i = 0; i < reconstruction->observations.size(); ++i) {
    const Observation& observation = reconstruction->observations[i];
    if (usable.empty() || usable[observation.camera])
      views[observation.point].push_back(i);
  }
  const PointSolver solver(*reconstruction, maximum_error);
  reconstruction->inliers.assign(reconstruction->observations.size(), false);
  for (std::size_t point = 0; point < views.size(); ++point) {
    const std::optional<Consensus> consensus = solver.solve(views[point]);
    reconstruction->points[point].reset();
    if (!consensus)
      continue;
    reconstruction->points[point] = consensus->point;
    for (const std::size_t view : consensus->inliers)
      reconstruction->inliers[view] = true;
  }
}

}  // namespace wiimote_tracker::bundle
