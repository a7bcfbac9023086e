#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_CUBIC_SPLINE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_CUBIC_SPLINE_H

#include <Eigen/Core>

namespace wiimote_tracker::adjust {

/// Weights of the four control points that shape a uniform cubic B-spline between two knots.
struct SplineWeights {
  Eigen::Vector4d value;  ///< Of the position; their sum is 1.
  Eigen::Vector4d rate;   ///< Of the velocity [1/s].
};

/// @param time since the first of the two knots [s]; beyond the interval it is extrapolated.
/// @param spacing of the knots [s].
inline SplineWeights splineWeights(double time, double spacing) {
  const double u = time / spacing;
  const double v = 1.0 - u;
  SplineWeights weights;
  weights.value << v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0,
      3.0 * v * v * v - 6.0 * v * v + 4.0, u * u * u;
  weights.value /= 6.0;
  weights.rate << -v * v, 3.0 * u * u - 4.0 * u, -3.0 * v * v + 4.0 * v, u * u;
  weights.rate /= 2.0 * spacing;
  return weights;
}

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_CUBIC_SPLINE_H
