#pragma once

#include "adjust/cubic_spline.h"
#include "adjust/pixel.h"

#include <Eigen/Core>

#include <cmath>

namespace wiimote_tracker::adjust {

/// Error of the pixel of a point that moves along a uniform cubic B-spline. Blocks: rotation,
/// position, lens, distortion, time offset (CameraBlocks), the four control points that shape the
/// path around the exposure (3 each) [m].
struct PathPixelError {
  PixelError pixel;
  double since_knot;  ///< The image's stamp after the first knot of its interval [s]. A time offset
                      ///< that leaves this interval extrapolates its polynomial.
  double spacing;     ///< Of the knots [s].

  ceres::CostFunction* cost() const { return pixelCostOf<1, 3, 3, 3, 3>(*this); }

  template <typename T>
  bool operator()(const T* rotation,
                  const T* position,
                  const T* lens,
                  const T* distortion,
                  const T* offset,
                  const T* control0,
                  const T* control1,
                  const T* control2,
                  const T* control3,
                  T* residual) const {
    const Eigen::Matrix<T, 4, 1> weights = splineWeights(T((since_knot + offset[0]) / spacing));
    T point[3];
    for (int i = 0; i < 3; ++i)
      point[i] = weights[0] * control0[i] + weights[1] * control1[i] + weights[2] * control2[i] +
                 weights[3] * control3[i];
    return pixel(rotation, position, lens, distortion, point, residual);
  }
};

/// Acceleration of a uniform cubic B-spline at a knot, whitened: the prior that bridges times in
/// which no camera sees the point. Blocks: the three control points around the knot (3 each) [m].
struct PathAccelerationError {
  double spacing;  ///< Of the knots [s].
  double stddev;   ///< Of the acceleration, per axis [m/s^2].

  ceres::CostFunction* cost() const { return costOf<3, 3, 3, 3>(*this); }

  template <typename T>
  bool operator()(const T* before, const T* at, const T* after, T* residual) const {
    for (int i = 0; i < 3; ++i)
      residual[i] = (before[i] - 2.0 * at[i] + after[i]) / (spacing * spacing * stddev);
    return true;
  }
};

/// Distance of a wand's two LEDs at a knot of their paths less the wand's length, whitened. Blocks:
/// the three control points around the knot of the one LED, those of the other (3 each) [m], the
/// length (1) [m].
struct WandLengthError {
  double stddev;  ///< Of the splines' distance from the length [m].

  ceres::CostFunction* cost() const { return costOf<1, 3, 3, 3, 3, 3, 3, 1>(*this); }

  /// False where both LEDs are at one place.
  template <typename T>
  bool operator()(const T* a0,
                  const T* a1,
                  const T* a2,
                  const T* b0,
                  const T* b1,
                  const T* b2,
                  const T* length,
                  T* residual) const {
    using std::sqrt;
    T squared(0.0);
    for (int i = 0; i < 3; ++i) {
      const T along = ((b0[i] - a0[i]) + 4.0 * (b1[i] - a1[i]) + (b2[i] - a2[i])) / 6.0;
      squared += along * along;
    }
    if (!(squared > T(0.0)))
      return false;
    *residual = (sqrt(squared) - *length) / stddev;
    return true;
  }
};

}  // namespace wiimote_tracker::adjust
