#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_CAMERA_PARAMETERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_CAMERA_PARAMETERS_H

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace wiimote_tracker::geometry {

/// Parameters of one camera in a rig's covariance (Rig::covariance), and where they stand
/// among them.
constexpr Eigen::Index kParameters = 16;
constexpr Eigen::Index kRotation = 0;
constexpr Eigen::Index kPosition = 3;
constexpr Eigen::Index kLens = 6;  ///< fx, fy, cx, cy, then the distortion.
constexpr Eigen::Index kDistortion = 10;
constexpr Eigen::Index kTimeOffset = 15;

using ParameterJacobian = Eigen::Matrix<double, 2, kParameters>;

/// Where those of a camera begin.
inline Eigen::Index firstParameter(std::size_t camera) {
  return kParameters * static_cast<Eigen::Index>(camera);
}

/// Whether the rig says how certain its cameras are.
inline bool hasCovariance(const Rig& rig) {
  return rig.covariance.size() > 0;
}

/// Pixel of a world point, and its derivatives.
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point;  ///< [px/m]
  /// By the camera's parameters. That of the time offset, for a point that stands still, is 0: a
  /// moving one adds by_point * velocity.
  ParameterJacobian by_parameters;
};

/// Nothing where the camera has no pixel of the point.
std::optional<Projection> projectionOf(const Camera& camera, const Eigen::Vector3d& point);

/// Same for the camera that a rig builds its rays with (Rig::rayCamera()). Derivatives by
/// parameters that the ray model replaces are 0.
std::optional<Projection> rayProjection(const Rig& rig,
                                        std::size_t camera,
                                        const Eigen::Vector3d& point);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_CAMERA_PARAMETERS_H
