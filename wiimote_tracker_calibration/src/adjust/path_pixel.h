#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_PIXEL_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_PIXEL_H

#include "adjust/cubic_spline.h"
#include "adjust/pixel.h"

#include <ceres/sized_cost_function.h>

#include <memory>

namespace wiimote_tracker::adjust {

/// Error of the pixel of a point that moves along a uniform cubic B-spline. Blocks: rotation,
/// position, lens, distortion, time offset (CameraBlocks), the four control points that shape the
/// path around the exposure (3 each) [m].
class PathPixelError : public ceres::SizedCostFunction<2,
                                                       kRotationSize,
                                                       kPositionSize,
                                                       kLensSize,
                                                       kDistortionSize,
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

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_PIXEL_H
