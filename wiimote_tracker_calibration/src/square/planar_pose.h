#pragma once

#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace wiimote_tracker::square {

/// A pose from which the corners look as they were seen: a minimum of the reprojection error.
struct PlanarPose {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();  ///< [m]
  double cost = 0.0;  ///< Sum of the squared distances in the image [px^2].
};

using PlanarPoses = std::vector<PlanarPose>;

/// Most probable poses of a camera that saw three or four of the corners, for pixel errors that are
/// Gaussian, independent and equal in both axes: the better first. Four have up to two: a plane and
/// its mirror image at the line of sight look nearly the same. They start from the derivative of
/// the homography in the middle of the corners (Collins and Bartoli, Infinitesimal Plane-Based Pose
/// Estimation, 2014). Three have up to four (Ke and Roumeliotis, An Efficient Algebraic Solution to
/// the Perspective-Three-Point Problem, 2017), and the image does not tell which. All are then
/// refined by Levenberg-Marquardt with the lens as it is.
/// @param pixels as observed, distorted [px].
/// @param corners of the same z, no three on a line.
/// Empty when no pose explains the pixels: three on one line, or beyond what the lens can image.
PlanarPoses cornerPoses(const geometry::Intrinsics& intrinsics,
                        const std::array<std::optional<Eigen::Vector2d>, 4>& pixels,
                        const Corners& corners);

/// Whether two poses are the same to within 0.02 degrees and 0.02 % of the distance to the square.
bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Corners& corners);

}  // namespace wiimote_tracker::square
