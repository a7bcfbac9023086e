#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_PROJECTION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_PROJECTION_H

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

namespace wiimote_tracker::wave {

/// Parameters of one camera: rotation 3 [rad] and position 3 [m] as in RigCalibration.msg; fx, fy,
/// cx, cy [px]; k1 of whichever lens model; time offset [s]. The other coefficients of the
/// distortion are held.
constexpr Eigen::Index kCameraSize = 12;
/// Where the time offset stands among them.
constexpr Eigen::Index kOffset = 11;

using CameraJacobian = Eigen::Matrix<double, 2, kCameraSize>;
using PointJacobian = Eigen::Matrix<double, 2, 3>;

/// Pixel of a world point, and its derivatives. The time offset moves a moving point only: its
/// column is 0 here.
struct Projection {
  Eigen::Vector2d pixel;
  PointJacobian by_point;
  CameraJacobian by_camera;
};

/// @returns false when the point is not in front of the camera.
bool project(const geometry::Camera& camera, const Eigen::Vector3d& point, Projection* result);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_PROJECTION_H
