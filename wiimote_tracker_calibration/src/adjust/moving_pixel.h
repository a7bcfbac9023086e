#pragma once

#include "adjust/pixel.h"

namespace wiimote_tracker::adjust {

/// Error of the pixel of a point that moves with constant velocity, on a known path. Blocks:
/// rotation, position, lens, distortion, time offset (CameraBlocks).
struct MovingPixelError {
  PixelError pixel;
  Eigen::Vector3d position;  ///< In the world, at `time_offset` [m].
  Eigen::Vector3d velocity;  ///< In the world [m/s].
  double time_offset;        ///< Of the camera [s].

  ceres::CostFunction* cost() const { return pixelCostOf<1>(*this); }

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

/// Error of the pixel of a moving point at one instant, interpolated between two images. A later
/// time offset moves the observed pixel back along its path. Blocks: rotation, position, lens,
/// distortion, time offset (CameraBlocks), point in the world at the instant (3) [m].
struct InterpolatedPixelError {
  PixelError pixel;          ///< Interpolated with `time_offset`.
  Eigen::Vector2d velocity;  ///< Of the observed pixel [px/s].
  double time_offset;        ///< [s]

  ceres::CostFunction* cost() const { return pixelCostOf<1, 3>(*this); }

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
