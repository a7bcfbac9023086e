#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_WAND_LENGTH_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_WAND_LENGTH_H

#include <ceres/autodiff_cost_function.h>

#include <cmath>

namespace wiimote_tracker::adjust {

/// Distance of a wand's two LEDs at a knot of their paths less the wand's length, whitened. Blocks:
/// the three control points around the knot of the one LED, those of the other (3 each) [m], the
/// length (1) [m].
struct WandLengthError {
  double stddev;  ///< Of the splines' distance from the length [m].

  ceres::CostFunction* cost() const {
    return new ceres::AutoDiffCostFunction<WandLengthError, 1, 3, 3, 3, 3, 3, 3, 1>(
        new WandLengthError(*this));
  }

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

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_WAND_LENGTH_H
