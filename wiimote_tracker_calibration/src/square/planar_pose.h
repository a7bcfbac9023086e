#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLANAR_POSE_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLANAR_POSE_H

#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>

namespace wiimote_tracker::square {

/// A pose from which the corners look as they were seen: a minimum of the reprojection error.
struct PlanarPose {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();  ///< [m]
  double cost = 0.0;  ///< Sum of the squared distances in the image [px^2].
};

/// None, one, or two poses: the better first.
class PlanarPoses {
 public:
  const PlanarPose* begin() const { return poses_.data(); }
  const PlanarPose* end() const { return poses_.data() + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const PlanarPose& operator[](std::size_t i) const { return poses_[i]; }

  /// Keeps the order, and the two best.
  void add(const PlanarPose& pose);

 private:
  std::array<PlanarPose, 2> poses_;
  std::size_t size_ = 0;
};

/// Most probable poses of a camera that saw the four corners, for pixel errors that are Gaussian,
/// independent and equal in both axes. A plane has up to two: the second is, nearly, its mirror
/// image at the line of sight. They start from the derivative of the homography in the middle of
/// the corners (Collins and Bartoli, Infinitesimal Plane-Based Pose Estimation, 2014), and are then
/// refined by Levenberg-Marquardt with the lens as it is. Does not allocate.
/// @param pixels as observed, distorted [px].
/// @param corners of the same z, no three on a line.
/// Empty when no pose explains the pixels: three on one line, or beyond what the lens can image.
PlanarPoses planarPoses(const geometry::Intrinsics& intrinsics,
                        const std::array<Eigen::Vector2d, 4>& pixels,
                        const Corners& corners);

/// Whether two poses are the same to within 0.02 degrees and 0.02 % of the distance to the square.
bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Corners& corners);

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLANAR_POSE_H
