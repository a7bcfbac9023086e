#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>

namespace wiimote_tracker {

/// Turns four cameras so that only the second one shares views with the first, and with the third
/// and fourth: the first looks one way, the third and fourth look the other, the second sees both.
inline void linkByTheSecond(geometry::Rig* rig) {
  const auto look = [&](std::size_t camera, double x, double to_x, double y) {
    rig->cameras[camera].camera.world_from_camera =
        geometry::lookAt({x, y, 1.0}, {to_x, 0.0, 1.0}, Eigen::Vector3d::UnitZ());
  };
  look(0, 0.0, -5.0, 0.0);
  look(1, 0.5, 0.5, -6.0);
  look(2, 1.0, 6.0, 0.0);
  look(3, 1.0, 6.0, 0.3);
}

}  // namespace wiimote_tracker
