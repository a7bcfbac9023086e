#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_H

#include "adjust/cubic_spline.h"
#include "adjust/pixel.h"

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include <cmath>
#include <memory>

namespace wiimote_tracker::adjust {

/// Error of the pixel of a point that moves along a uniform cubic B-spline. Blocks: rotation,
/// position, lens, distortion, time offset (CameraBlocks), the four control points that shape the
/// path around the exposure (3 each) [m].
class PathPixelError : public ceres::SizedCostFunction<2,
                                                       kRotationSize,
                                                       kPositionSize,
                                                       kLensSize,
                                                       kHigherDistortionSize,
                                                       1,
                                                       3,
                                                       3,
                                                       3,
                                                       3> {
 public:
  /// @param since_knot the image's stamp after the first knot of its interval [s]. A time
  /// offset that leaves this interval extrapolates its polynomial.
  /// @param spacing of the knots [s].
  PathPixelError(const PixelError& pixel, double since_knot, double spacing)
      : pixel_(pixel.cost()), since_knot_(since_knot), spacing_(spacing) {}

  /// Chain rule over the point: 18 dual numbers instead of 28.
  bool Evaluate(double const* const* blocks, double* residual, double** jacobians) const override {
    constexpr int kOffset = 4;
    constexpr int kControls = 5;
    const SplineWeights weights = splineWeights(since_knot_ + *blocks[kOffset], spacing_);
    Eigen::Matrix<double, 3, 4> controls;
    for (int k = 0; k < 4; ++k)
      controls.col(k) = Eigen::Map<const Eigen::Vector3d>(blocks[kControls + k]);
    const Eigen::Vector3d point = controls * weights.value;
    const double* const pixel_blocks[] = {blocks[0], blocks[1], blocks[2], blocks[3], point.data()};
    if (!jacobians)
      return pixel_->Evaluate(pixel_blocks, residual, nullptr);

    using PointJacobian = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
    PointJacobian by_point;
    double* by_pixel_blocks[] = {jacobians[0], jacobians[1], jacobians[2], jacobians[3],
                                 by_point.data()};
    if (!pixel_->Evaluate(pixel_blocks, residual, by_pixel_blocks))
      return false;
    if (jacobians[kOffset])
      Eigen::Map<Eigen::Vector2d>{jacobians[kOffset]} = by_point * (controls * weights.rate);
    for (int k = 0; k < 4; ++k) {
      if (jacobians[kControls + k])
        Eigen::Map<PointJacobian>{jacobians[kControls + k]} = weights.value[k] * by_point;
    }
    return true;
  }

 private:
  std::unique_ptr<const ceres::CostFunction> pixel_;
  double since_knot_;
  double spacing_;
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

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_H
