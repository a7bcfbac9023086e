#include "camera_blocks.h"

#include <ceres/rotation.h>

#include <algorithm>

namespace wiimote_tracker::bundle {

CameraBlocks blocksOf(const geometry::Camera& camera) {
  const geometry::Intrinsics& in = camera.intrinsics;
  const auto& k = in.distortion;
  CameraBlocks blocks;
  blocks.intrinsics = {in.fx, in.fy, in.cx, in.cy, k[0], k[1], k[2], k[3], k[4]};
  const Eigen::Matrix3d camera_from_world = camera.world_from_camera.linear().transpose();
  ceres::RotationMatrixToAngleAxis(camera_from_world.data(), blocks.rotation.data());
  blocks.position = camera.center();
  return blocks;
}

void setCamera(const CameraBlocks& blocks, geometry::Camera* camera) {
  geometry::Intrinsics& in = camera->intrinsics;
  const auto& values = blocks.intrinsics;
  in.fx = values[0];
  in.fy = values[1];
  in.cx = values[2];
  in.cy = values[3];
  std::copy(values.begin() + 4, values.end(), in.distortion.begin());
  Eigen::Matrix3d camera_from_world;
  ceres::AngleAxisToRotationMatrix(blocks.rotation.data(), camera_from_world.data());
  camera->world_from_camera.linear() = camera_from_world.transpose();
  camera->world_from_camera.translation() = blocks.position;
}

}  // namespace wiimote_tracker::bundle
