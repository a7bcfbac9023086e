#pragma once

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::square {

/// Where one camera saw the corners, and its starting values.
struct CameraSightings {
  std::string name;
  std::string identity;                                   ///< Empty if unknown.
  geometry::Intrinsics intrinsics;                        ///< Starting values.
  std::array<std::optional<Eigen::Vector2d>, 4> corners;  ///< Distorted [px]; nothing: not seen.
  std::vector<std::optional<Eigen::Vector2d>> places;     ///< The same of SquareLayout::places.
  std::optional<Eigen::Vector3d> gravity;  ///< Specific force at rest, optical frame [m/s^2].

  /// How many of the corners it saw.
  std::size_t cornersSeen() const {
    return static_cast<std::size_t>(
        std::count_if(corners.begin(), corners.end(), [](const auto& p) { return p.has_value(); }));
  }

  /// The camera with its starting values at some pose.
  geometry::Camera camera(
      const Eigen::Isometry3d& world_from_camera = Eigen::Isometry3d::Identity()) const {
    return {name, identity, intrinsics, world_from_camera};
  }

  /// Angle between the up of a world and the accelerometer's with the camera at some pose [rad];
  /// nothing without accelerometer.
  std::optional<double> tilt(const Eigen::Isometry3d& world_from_camera, bool z_up) const {
    if (!gravity)
      return std::nullopt;
    const Eigen::Vector3d up(0.0, 0.0, z_up ? 1.0 : -1.0);
    const Eigen::Vector3d measured = world_from_camera.linear() * gravity->normalized();
    return std::atan2(up.cross(measured).norm(), up.dot(measured));
  }
};

}  // namespace wiimote_tracker::square
