#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::geometry {

/// The ray of a pixel, prepared for repeated triangulation: the lens is inverted once. Residuals
/// are those of the lens linearised at the pixel, whose error is about the squared residual over
/// the focal length.
struct Sight {
  Eigen::Vector3d origin;     ///< Optical centre, world [m].
  Eigen::Vector3d direction;  ///< Of the pixel's ray, world, unit length.
  Eigen::Vector3d axis;       ///< Optical axis, world, unit length.

  /// d pixel / d (position in the camera's plane of depth 1 m), in world axes [px]; zero along
  /// direction.
  Eigen::Matrix<double, 2, 3> pixel_by_offset;

  /// Distance along the optical axis of a world point [m].
  double depth(const Eigen::Vector3d& point) const { return axis.dot(point - origin); }

  /// Pixel of a world point less the observed pixel [px]; the point must have a depth above 0.
  Eigen::Vector2d residual(const Eigen::Vector3d& point) const {
    return pixel_by_offset * (point - origin) / depth(point);
  }

  /// 3x2 derivative of direction by the pixel [1/px].
  Eigen::Matrix<double, 3, 2> directionByPixel() const;
};

/// Nothing when the pixel has no ray (see Intrinsics::normalizedFromPixel).
std::optional<Sight> sightFromPixel(const Camera& camera, const Eigen::Vector2d& pixel);

}  // namespace wiimote_tracker::geometry
