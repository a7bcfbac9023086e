#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_COVERAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_COVERAGE_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::geometry {

/// What the cameras of a rig make of a point in the middle of a cell.
struct CoverageCell {
  Eigen::Vector3d center;   ///< World [m].
  std::size_t cameras = 0;  ///< That see it, if nothing is in between.
  /// Predicted standard deviation sqrt(trace of the covariance) of a single point [m], by the noise
  /// of its pixels and the error of the calibration, if that is known. NaN: not determined.
  double stddev;
};

/// Divides a box of the world [m] into cubes.
/// @param size of the cubes [m, > 0]; those at the upper faces may stand out of the box.
/// @param pixel_stddev of each pixel coordinate [px, > 0].
/// @throws Error: more than 100000 cells.
std::vector<CoverageCell> coverageOf(const Rig& rig,
                                     const Eigen::AlignedBox3d& box,
                                     double size,
                                     double pixel_stddev);

/// Share of the cells that at least two cameras see [0..1]; 0 without cells.
double coveredShare(const std::vector<CoverageCell>& cells);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_COVERAGE_H
