#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_CORNER_PIXEL_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_CORNER_PIXEL_H

#include "adjust/pixel.h"

namespace wiimote_tracker::adjust {

/// Error of the pixel of a corner of the square. Blocks: rotation, position, lens, distortion
/// (CameraBlocks), horizontal displacement of the corner from its place (2) [m].
struct CornerPixelError {
  PixelError pixel;
  Eigen::Vector3d nominal;  ///< The corner's place in the layout [m].

  ceres::CostFunction* cost() const {
    return new ceres::AutoDiffCostFunction<CornerPixelError, 2, kRotationSize, kPositionSize,
                                           kLensSize, kDistortionSize, 2>(
        new CornerPixelError(*this));
  }

  template <typename T>
  bool operator()(const T* rotation,
                  const T* position,
                  const T* lens,
                  const T* distortion,
                  const T* offset,
                  T* residual) const {
    const T corner[3] = {nominal.x() + offset[0], nominal.y() + offset[1], T(nominal.z())};
    return pixel(rotation, position, lens, distortion, corner, residual);
  }
};

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_CORNER_PIXEL_H
