#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_ACCELERATION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_ACCELERATION_H

#include <ceres/autodiff_cost_function.h>

namespace wiimote_tracker::adjust {

/// Acceleration of a uniform cubic B-spline at a knot, whitened: the prior that bridges times in
/// which no camera sees the point. Blocks: the three control points around the knot (3 each) [m].
struct PathAccelerationError {
  double spacing;  ///< Of the knots [s].
  double stddev;   ///< Of the acceleration, per axis [m/s^2].

  ceres::CostFunction* cost() const {
    return new ceres::AutoDiffCostFunction<PathAccelerationError, 3, 3, 3, 3>(
        new PathAccelerationError(*this));
  }

  template <typename T>
  bool operator()(const T* before, const T* at, const T* after, T* residual) const {
    for (int i = 0; i < 3; ++i)
      residual[i] = (before[i] - 2.0 * at[i] + after[i]) / (spacing * spacing * stddev);
    return true;
  }
};

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PATH_ACCELERATION_H
