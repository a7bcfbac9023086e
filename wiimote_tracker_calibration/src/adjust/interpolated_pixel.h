#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_INTERPOLATED_PIXEL_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_INTERPOLATED_PIXEL_H

#include "adjust/pixel.h"

namespace wiimote_tracker::adjust {

/// Error of the pixel of a moving point at one instant, interpolated between two images. A later
/// time offset moves the observed pixel back along its path. Blocks: rotation, position, lens,
/// distortion, time offset (CameraBlocks), point in the world at the instant (3) [m].
struct InterpolatedPixelError {
  PixelError pixel;          ///< Interpolated with `time_offset`.
  Eigen::Vector2d velocity;  ///< Of the observed pixel [px/s].
  double time_offset;        ///< [s]

  ceres::CostFunction* cost() const {
    return new ceres::AutoDiffCostFunction<InterpolatedPixelError, 2, kRotationSize, kPositionSize,
                                           kLensSize, kDistortionSize, 1, 3>(
        new InterpolatedPixelError(*this));
  }

  template <typename T>
  bool operator()(const T* rotation,
                  const T* position,
                  const T* lens,
                  const T* distortion,
                  const T* offset,
                  const T* point,
                  T* residual) const {
    if (!pixel(rotation, position, lens, distortion, point, residual))
      return false;
    const Eigen::Vector2d whitened = pixel.whitening * velocity;
    for (int i = 0; i < 2; ++i)
      residual[i] += whitened[i] * (offset[0] - time_offset);
    return true;
  }
};

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_INTERPOLATED_PIXEL_H
