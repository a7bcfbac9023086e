#pragma once

#include <Eigen/Core>

namespace wiimote_tracker::adjust {

/// Weights of the four control points of a uniform cubic B-spline, of which the position between
/// two knots is the mean; their sum is 1.
/// @param u time since the first of the two knots over their spacing; beyond 1 it is extrapolated.
template <typename T>
Eigen::Matrix<T, 4, 1> splineWeights(const T& u) {
  const T v = 1.0 - u;
  Eigen::Matrix<T, 4, 1> weights;
  weights << v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0, 3.0 * v * v * v - 6.0 * v * v + 4.0,
      u * u * u;
  return weights / T(6.0);
}

/// Their derivatives by u.
inline Eigen::Vector4d splineRates(double u) {
  const double v = 1.0 - u;
  return Eigen::Vector4d(-v * v, 3.0 * u * u - 4.0 * u, -3.0 * v * v + 4.0 * v, u * u) / 2.0;
}

}  // namespace wiimote_tracker::adjust
