#include "projection.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <cmath>

namespace wiimote_tracker::wave {

bool project(const geometry::Camera& camera, const Eigen::Vector3d& point, Projection* result) {
  const Eigen::Matrix3d camera_from_world = camera.world_from_camera.linear().transpose();
  const Eigen::Vector3d from_center = point - camera.center();
  const Eigen::Vector3d in_camera = camera_from_world * from_center;
  const double z = in_camera.z();
  if (!(z > 1e-6))
    return false;
  const Eigen::Vector2d normalized = in_camera.head<2>() / z;
  Eigen::Matrix2d by_normalized;
  result->pixel = camera.intrinsics.pixelFromNormalized(normalized, &by_normalized);
  PointJacobian normalized_by_point;
  normalized_by_point << 1.0 / z, 0.0, -normalized.x() / z, 0.0, 1.0 / z, -normalized.y() / z;
  result->by_point = by_normalized * normalized_by_point * camera_from_world;

  const geometry::Intrinsics& lens = camera.intrinsics;
  const double r2 = normalized.squaredNorm();
  CameraJacobian& by_camera = result->by_camera;
  by_camera.setZero();
  // exp([w]x) turns the camera, which is turning the point the other way.
  by_camera.leftCols<3>() = result->by_point * geometry::so3::skew(from_center);
  by_camera.middleCols<3>(3) = -result->by_point;
  by_camera(0, 6) = (result->pixel.x() - lens.cx) / lens.fx;
  by_camera(1, 7) = (result->pixel.y() - lens.cy) / lens.fy;
  by_camera(0, 8) = 1.0;
  by_camera(1, 9) = 1.0;
  // k1 goes with the third power of the radius, or of the angle from the axis.
  double by_k1 = r2;
  if (lens.distortion_model == geometry::DistortionModel::kEquidistant && r2 > 0.0) {
    const double r = std::sqrt(r2);
    by_k1 = std::pow(std::atan(r), 3) / r;
  }
  by_camera(0, 10) = lens.fx * normalized.x() * by_k1;
  by_camera(1, 10) = lens.fy * normalized.y() * by_k1;
  return true;
}

}  // namespace wiimote_tracker::wave
