#include "wiimote_tracker_triangulation/geometry/coverage.h"

#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::geometry {
namespace {

constexpr double kMostCells = 1e5;

double predictedStddev(const Rig& rig,
                       const CalibrationUncertainty& calibration,
                       const Eigen::Vector3d& point,
                       const std::vector<std::size_t>& indices,
                       const TriangulationOptions& options) {
  std::vector<Camera> cameras;
  cameras.reserve(indices.size());
  for (const std::size_t index : indices)
    cameras.push_back(rig.rayCamera(rig.cameras[index]));
  std::vector<Observation> observations;
  observations.reserve(cameras.size());
  for (const Camera& camera : cameras)
    observations.push_back({&camera, *camera.project(point)});
  const auto found = triangulate(observations, options);
  if (!found)
    return std::numeric_limits<double>::quiet_NaN();
  const auto systematic = calibration.covarianceOf(point, indices.data(), indices.size());
  return std::sqrt(found->covariance.trace() + (systematic ? systematic->trace() : 0.0));
}

}  // namespace

std::vector<CoverageCell> coverageOf(const Rig& rig,
                                     const Eigen::AlignedBox3d& box,
                                     double size,
                                     double pixel_stddev) {
  const CalibrationUncertainty calibration(rig);
  TriangulationOptions options;
  options.pixel_stddev = pixel_stddev;
  const Eigen::Array3d counts = (box.sizes().array() / size - 1e-9).ceil().max(1.0);
  if (!(counts.prod() <= kMostCells))
    throw Error(
        format("the volume has more than %.0f cells: make ~cell_size larger or ~volume "
               "smaller",
               kMostCells));
  std::vector<CoverageCell> cells;
  for (int z = 0; z < counts.z(); ++z) {
    for (int y = 0; y < counts.y(); ++y) {
      for (int x = 0; x < counts.x(); ++x) {
        CoverageCell cell;
        cell.center = box.min() + size * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
        const std::vector<std::size_t> seeing = camerasSeeing(rig, cell.center);
        cell.cameras = seeing.size();
        cell.stddev = predictedStddev(rig, calibration, cell.center, seeing, options);
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

double coveredShare(const std::vector<CoverageCell>& cells) {
  const auto covered = std::count_if(cells.begin(), cells.end(),
                                     [](const CoverageCell& cell) { return cell.cameras >= 2; });
  return cells.empty() ? 0.0 : static_cast<double>(covered) / static_cast<double>(cells.size());
}

}  // namespace wiimote_tracker::geometry
