#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PRIOR_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PRIOR_H

#include <ceres/autodiff_cost_function.h>

#include <array>
#include <cstddef>

namespace wiimote_tracker::adjust {

/// Gaussian prior of independent values, whitened: the place of a corner, the length of a wand, the
/// offset of a clock, distortion coefficients. Block: the values.
template <int Size>
struct Prior {
  std::array<double, Size> mean;
  std::array<double, Size> stddev;

  ceres::CostFunction* cost() const {
    return new ceres::AutoDiffCostFunction<Prior, Size, Size>(new Prior(*this));
  }

  template <typename T>
  bool operator()(const T* values, T* residual) const {
    for (std::size_t i = 0; i < Size; ++i)
      residual[i] = (values[i] - mean[i]) / stddev[i];
    return true;
  }
};

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_PRIOR_H
