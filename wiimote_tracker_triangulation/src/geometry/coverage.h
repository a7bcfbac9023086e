#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::geometry {

/// A box of the world [m], divided into cubes; those at the upper faces may stand out of it.
class CellGrid {
 public:
  /// @param size of the cubes [m, > 0]. @throws Error: more than 100000 cells.
  CellGrid(const Eigen::AlignedBox3d& box, double size);

  std::size_t count() const { return static_cast<std::size_t>(counts_.prod()); }
  Eigen::Vector3d center(std::size_t cell) const;
  /// Nothing outside of the cells.
  std::optional<std::size_t> cellAt(const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d origin_;
  double size_;
  Eigen::Array<Eigen::Index, 3, 1> counts_;
};

/// What the cameras of a rig make of a point in the middle of a cell.
struct CoverageCell {
  Eigen::Vector3d center;   ///< World [m].
  std::size_t cameras = 0;  ///< That see it, if nothing is in between.
  /// Predicted standard deviation sqrt(trace of the covariance) of a single point [m], by the noise
  /// of its pixels and the error of the calibration, if that is known. NaN: not determined.
  double stddev;
};

/// @param pixel_stddev of each pixel coordinate [px, > 0].
std::vector<CoverageCell> coverageOf(const Rig& rig, const CellGrid& grid, double pixel_stddev);

/// Share of the cells that at least two cameras see [0..1]; 0 without cells.
double coveredShare(const std::vector<CoverageCell>& cells);

/// Another aim of one camera, by which more cells are seen by two cameras.
struct CameraTurn {
  std::string camera;
  double right;  ///< About its vertical image axis [rad]; negative: to the left.
  double up;     ///< About its horizontal image axis [rad]; negative: down.
  double share;  ///< coveredShare() then.
};

/// The best turn of one camera, up to 30 degrees each way in steps of 5. Of many cells only so many
/// are looked at that it takes about a second. Nothing: none gains 0.02 of the cells.
std::optional<CameraTurn> bestTurn(const Rig& rig, const CellGrid& grid);

}  // namespace wiimote_tracker::geometry
