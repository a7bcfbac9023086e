#pragma once

#include "adjust/pixel.h"

namespace wiimote_tracker::adjust {

/// The world's up against that of a camera's accelerometer, whitened: the difference of two unit
/// vectors, whose length grows with the angle up to 180 degrees. Block: rotation (CameraBlocks).
struct GravityError {
  Eigen::Vector3d up_in_camera;
  Eigen::Vector3d up_in_world;
  Eigen::Matrix3d world_from_start;
  double stddev;  ///< [rad]

  ceres::CostFunction* cost() const { return costOf<3, kRotationSize>(*this); }

  template <typename T>
  bool operator()(const T* rotation, T* residual) const {
    const T up[3] = {T(up_in_world.x()), T(up_in_world.y()), T(up_in_world.z())};
    T turned[3];
    cameraFromWorld(rotation, world_from_start, up, turned);
    for (int i = 0; i < 3; ++i)
      residual[i] = (turned[i] - up_in_camera[i]) / stddev;
    return true;
  }
};

}  // namespace wiimote_tracker::adjust
