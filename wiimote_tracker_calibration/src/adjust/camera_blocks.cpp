#include "adjust/camera_blocks.h"

#include <ceres/rotation.h>

#include <algorithm>

namespace wiimote_tracker::adjust {

CameraBlocks::CameraBlocks(const geometry::Camera& camera, double offset)
    : world_from_start(camera.world_from_camera.linear()),
      distortion_model(camera.intrinsics.distortion_model),
      rotation{},
      time_offset(offset) {
  const Eigen::Vector3d center = camera.center();
  position = {center.x(), center.y(), center.z()};
  const geometry::Intrinsics& in = camera.intrinsics;
  lens = {in.fx, in.fy, in.cx, in.cy, in.distortion[0]};
  std::copy(in.distortion.begin() + 1, in.distortion.end(), higher_distortion.begin());
}

geometry::Camera CameraBlocks::cameraLike(const geometry::Camera& other) const {
  geometry::Camera camera = other;
  Eigen::Matrix3d turn;
  ceres::AngleAxisToRotationMatrix(rotation.data(), turn.data());
  camera.world_from_camera.linear() =
      Eigen::Quaterniond(turn * world_from_start).normalized().toRotationMatrix();
  camera.world_from_camera.translation() = Eigen::Map<const Eigen::Vector3d>(position.data());
  geometry::Intrinsics& in = camera.intrinsics;
  in.fx = lens[0];
  in.fy = lens[1];
  in.cx = lens[2];
  in.cy = lens[3];
  in.distortion[0] = lens[4];
  std::copy(higher_distortion.begin(), higher_distortion.end(), in.distortion.begin() + 1);
  return camera;
}

}  // namespace wiimote_tracker::adjust
