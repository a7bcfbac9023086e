#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_MOVING_PIXEL_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_MOVING_PIXEL_H

#include "adjust/pixel.h"

namespace wiimote_tracker::adjust {

/// Error of the pixel of a point that moves with constant velocity, on a known path. Blocks:
/// rotation, position, lens, distortion, time offset (CameraBlocks).
struct MovingPixelError {
  PixelError pixel;
  Eigen::Vector3d position;  ///< In the world, at `time_offset` [m].
  Eigen::Vector3d velocity;  ///< In the world [m/s].
  double time_offset;        ///< Of the camera [s].

  ceres::CostFunction* cost() const {
    return new ceres::AutoDiffCostFunction<MovingPixelError, 2, kRotationSize, kPositionSize,
                                           kLensSize, kDistortionSize, 1>(
        new MovingPixelError(*this));
  }

  template <typename T>
  bool operator()(const T* rotation,
                  const T* center,
                  const T* lens,
                  const T* distortion,
                  const T* offset,
                  T* residual) const {
    const T elapsed = offset[0] - time_offset;
    T point[3];
    for (int i = 0; i < 3; ++i)
      point[i] = position[i] + elapsed * velocity[i];
    return pixel(rotation, center, lens, distortion, point, residual);
  }
};

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_MOVING_PIXEL_H
