#include "geometry/coverage.h"

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

// Of bestTurn().
constexpr int kAims = 13;  // of a camera, about each axis
constexpr double kAimStep = 5.0 * M_PI / 180.0;
constexpr double kMostLooks = 3e6;  // of a camera at a cell
constexpr double kLeastGain = 0.02;
constexpr double kTurnCost = 0.01;  // of share for a radian: small turns first

/// Centers of so many cells that all aims of so many cameras take about a second.
std::vector<Eigen::Vector3d> somePlaces(const CellGrid& grid, std::size_t cameras) {
  const double most = kMostLooks / (cameras * kAims * kAims);
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::ceil(grid.count() / most)));
  std::vector<Eigen::Vector3d> places;
  places.reserve(grid.count() / stride + 1);
  for (std::size_t i = 0; i < grid.count(); i += stride)
    places.push_back(grid.center(i));
  return places;
}

/// Adds `amount` for each place that a camera sees.
void addSights(const Camera& camera,
               const std::vector<Eigen::Vector3d>& places,
               int amount,
               std::vector<int>* seen) {
  for (std::size_t i = 0; i < places.size(); ++i)
    (*seen)[i] += camera.sees(places[i]) ? amount : 0;
}

/// The camera at the same place, turned about its image's axes [rad].
Camera turned(Camera camera, double right, double up) {
  camera.world_from_camera.rotate(Eigen::AngleAxisd(right, Eigen::Vector3d::UnitY()))
      .rotate(Eigen::AngleAxisd(up, Eigen::Vector3d::UnitX()));
  return camera;
}

/// @param others how many other cameras see each place.
std::size_t seenByTwo(const Camera& camera,
                      const std::vector<Eigen::Vector3d>& places,
                      const std::vector<int>& others) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    count += others[i] >= 2 || (others[i] == 1 && camera.sees(places[i])) ? 1 : 0;
  return count;
}

/// @param seeing the cameras that see the point.
double predictedStddev(const std::vector<Camera>& cameras,
                       const CalibrationUncertainty& calibration,
                       const Eigen::Vector3d& point,
                       const std::vector<std::size_t>& seeing,
                       const TriangulationOptions& options) {
  std::vector<Observation> observations;
  for (const std::size_t camera : seeing)
    observations.push_back({&cameras[camera], *cameras[camera].project(point)});
  const auto found = triangulate(observations, options);
  if (!found)
    return std::numeric_limits<double>::quiet_NaN();
  const auto systematic = calibration.covarianceOf(point, seeing.data(), seeing.size());
  return std::sqrt(found->covariance.trace() + (systematic ? systematic->trace() : 0.0));
}

}  // namespace

CellGrid::CellGrid(const Eigen::AlignedBox3d& box, double size) : origin_(box.min()), size_(size) {
  const Eigen::Array3d counts = (box.sizes().array() / size - 1e-9).ceil().max(1.0);
  if (!(counts.prod() <= kMostCells))
    throw Error(
        format("the volume has more than %.0f cells: make ~cell_size larger or ~volume "
               "smaller",
               kMostCells));
  counts_ = counts.cast<Eigen::Index>();
}

Eigen::Vector3d CellGrid::center(std::size_t cell) const {
  const auto index = static_cast<Eigen::Index>(cell);
  const Eigen::Array<Eigen::Index, 3, 1> place(
      index % counts_.x(), index / counts_.x() % counts_.y(), index / (counts_.x() * counts_.y()));
  return origin_ + size_ * (place.cast<double>() + 0.5).matrix();
}

std::optional<std::size_t> CellGrid::cellAt(const Eigen::Vector3d& point) const {
  const Eigen::Array3d place = (point - origin_).array() / size_;
  if (!(place >= 0.0).all() || !(place < counts_.cast<double>()).all())
    return std::nullopt;
  const Eigen::Array<Eigen::Index, 3, 1> index = place.cast<Eigen::Index>();
  return static_cast<std::size_t>(index.x() + counts_.x() * (index.y() + counts_.y() * index.z()));
}

std::vector<CoverageCell> coverageOf(const Rig& rig, const CellGrid& grid, double pixel_stddev) {
  const std::vector<Camera> cameras = rig.rayCameras();
  const CalibrationUncertainty calibration(rig);
  TriangulationOptions options;
  options.pixel_stddev = pixel_stddev;
  std::vector<CoverageCell> cells;
  cells.reserve(grid.count());
  for (std::size_t i = 0; i < grid.count(); ++i) {
    CoverageCell cell;
    cell.center = grid.center(i);
    const std::vector<std::size_t> seeing = camerasSeeing(rig, cell.center);
    cell.cameras = seeing.size();
    cell.stddev = predictedStddev(cameras, calibration, cell.center, seeing, options);
    cells.push_back(cell);
  }
  return cells;
}

double coveredShare(const std::vector<CoverageCell>& cells) {
  const auto covered = std::count_if(cells.begin(), cells.end(),
                                     [](const CoverageCell& cell) { return cell.cameras >= 2; });
  return cells.empty() ? 0.0 : static_cast<double>(covered) / static_cast<double>(cells.size());
}

std::optional<CameraTurn> bestTurn(const Rig& rig, const CellGrid& grid) {
  const std::vector<Camera> cameras = rig.rayCameras();
  const std::vector<Eigen::Vector3d> places = somePlaces(grid, cameras.size());
  const auto share = [&](auto count) {
    return static_cast<double>(count) / static_cast<double>(places.size());
  };
  std::vector<int> seen(places.size(), 0);  // by so many cameras
  for (const Camera& camera : cameras)
    addSights(camera, places, 1, &seen);

  std::optional<CameraTurn> best;
  double best_score =
      share(std::count_if(seen.begin(), seen.end(), [](int n) { return n >= 2; })) + kLeastGain;
  for (const Camera& camera : cameras) {
    std::vector<int> others = seen;
    addSights(camera, places, -1, &others);
    for (int aim = 0; aim < kAims * kAims; ++aim) {
      const int column = aim % kAims - kAims / 2, row = aim / kAims - kAims / 2;
      const double right = kAimStep * column, up = kAimStep * row;
      const double gained = share(seenByTwo(turned(camera, right, up), places, others));
      const double score = gained - kTurnCost * (std::abs(right) + std::abs(up));
      if (score <= best_score)
        continue;
      best_score = score;
      best = CameraTurn{camera.name, right, up, gained};
    }
  }
  return best;
}

}  // namespace wiimote_tracker::geometry
