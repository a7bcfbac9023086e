#pragma once

#include "adjust/pixel.h"

#include <Eigen/Core>

#include <cmath>

namespace wiimote_tracker::adjust {

/// Error of the pixel of a corner of the square. Blocks: rotation, position, lens, distortion
/// (CameraBlocks), horizontal displacement of the corner from its place (2) [m].
struct CornerPixelError {
  PixelError pixel;
  Eigen::Vector3d nominal;  ///< The corner's place in the layout [m].

  ceres::CostFunction* cost() const { return pixelCostOf<2>(*this); }

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

/// Distance between two corners of the square less the length by tape, whitened. Blocks: horizontal
/// displacement of the one and of the other corner from its place in the layout (2 each) [m].
struct TapedLengthError {
  Eigen::Vector2d nominal;  ///< From the one's place to the other's [m].
  double length;            ///< [m]
  double stddev;            ///< [m]

  ceres::CostFunction* cost() const { return costOf<1, 2, 2>(*this); }

  /// False where both are at one place.
  template <typename T>
  bool operator()(const T* from, const T* to, T* residual) const {
    using std::sqrt;
    const T x = nominal.x() + to[0] - from[0];
    const T y = nominal.y() + to[1] - from[1];
    const T squared = x * x + y * y;
    if (!(squared > T(0.0)))
      return false;
    *residual = (sqrt(squared) - length) / stddev;
    return true;
  }
};

}  // namespace wiimote_tracker::adjust
