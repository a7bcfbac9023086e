#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <Eigen/LU>

namespace wiimote_tracker::geometry {

Eigen::Matrix<double, 3, 2> Sight::directionByPixel() const {
  // The pseudo-inverse: the rows of pixel_by_offset are perpendicular to direction, as is any
  // change of a unit vector.
  const Eigen::Matrix2d squared = pixel_by_offset * pixel_by_offset.transpose();
  return axis.dot(direction) * pixel_by_offset.transpose() * squared.inverse();
}

std::optional<Sight> sightFromPixel(const Camera& camera, const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector2d> n = camera.intrinsics.normalizedFromPixel(pixel);
  if (!n)
    return std::nullopt;
  const auto rotation = camera.world_from_camera.linear();
  Eigen::Matrix2d pixel_by_normalized;
  camera.intrinsics.pixelFromNormalized(*n, &pixel_by_normalized);
  Sight sight;
  sight.origin = camera.center();
  sight.axis = rotation.col(2);
  sight.direction = (rotation * n->homogeneous()).normalized();
  // Of the normalised point (x, y) = (X, Y) / Z at Z = 1: d x = d X - x d Z.
  Eigen::Matrix<double, 2, 3> normalized_by_offset = rotation.leftCols<2>().transpose();
  normalized_by_offset -= *n * sight.axis.transpose();
  sight.pixel_by_offset.noalias() = pixel_by_normalized * normalized_by_offset;
  return sight;
}

}  // namespace wiimote_tracker::geometry
