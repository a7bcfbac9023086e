#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::square {

/// How points move with the parameters of the rig, three rows each.
/// @param points those that fewer than two cameras see, or all from one place, are removed.
Eigen::MatrixXd pointsByParameters(const geometry::Rig& rig, std::vector<Eigen::Vector3d>* points);

/// RMS error, all three axes together [m], of points triangulated by maximum likelihood from all
/// cameras that see them, as far as it comes from the calibration: the joint covariance of the rig
/// propagated to first order. Pixel noise comes on top. Points that fewer than two cameras see, or
/// all from one place, do not count. NaN when the rig has no covariance, or no point counts.
double expectedError(const geometry::Rig& rig, std::vector<Eigen::Vector3d> points);

/// The same after the best rigid motion of the points: independent of where the world is. NaN when
/// fewer than three points count.
double expectedShapeError(const geometry::Rig& rig, std::vector<Eigen::Vector3d> points);

/// Corners and middle of the box over the square that is as high as its shorter side [m].
std::vector<Eigen::Vector3d> boxOver(const std::array<Eigen::Vector3d, 4>& corners, bool z_up);

}  // namespace wiimote_tracker::square
