#include "adjust/camera_blocks.h"

#include <ceres/rotation.h>

#include <algorithm>

namespace wiimote_tracker::adjust {

CameraBlocks::CameraBlocks(const geometry::Camera& camera, double offset)
    : world_from_start(camera.world_from_camera.linear()),
      distortion_model(camera.intrinsics.distortion_model) {
  const Eigen::Vector3d center = camera.center();
  const geometry::Intrinsics& in = camera.intrinsics;
  values = {0.0, 0.0, 0.0, center.x(), center.y(), center.z(), in.fx, in.fy, in.cx, in.cy};
  std::copy(in.distortion.begin(), in.distortion.end(), values.begin() + geometry::kDistortion);
  values.back() = offset;
}

geometry::Camera CameraBlocks::cameraLike(const geometry::Camera& other) const {
  geometry::Camera camera = other;
  Eigen::Matrix3d turn;
  ceres::AngleAxisToRotationMatrix(values.data(), turn.data());
  camera.world_from_camera.linear() =
      Eigen::Quaterniond(turn * world_from_start).normalized().toRotationMatrix();
  const double* next = values.data() + geometry::kPosition;
  camera.world_from_camera.translation() = Eigen::Map<const Eigen::Vector3d>(next);
  next += kPositionSize;
  geometry::Intrinsics& in = camera.intrinsics;
  for (double* const value : {&in.fx, &in.fy, &in.cx, &in.cy})
    *value = *next++;
  std::copy_n(next, in.distortion.size(), in.distortion.begin());
  return camera;
}

}  // namespace wiimote_tracker::adjust
