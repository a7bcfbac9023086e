#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CAMERA_BLOCKS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CAMERA_BLOCKS_H

#include "reprojection_cost.h"

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <array>

namespace wiimote_tracker::bundle {

/// What Ceres varies of one camera: the blocks of ReprojectionCost.
struct CameraBlocks {
  std::array<double, kIntrinsicsSize> intrinsics;
  Eigen::Vector3d rotation;  ///< camera_from_world, angle-axis [rad].
  Eigen::Vector3d position;  ///< Optical centre, world [m].
};

CameraBlocks blocksOf(const geometry::Camera& camera);

void setCamera(const CameraBlocks& blocks, geometry::Camera* camera);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CAMERA_BLOCKS_H
