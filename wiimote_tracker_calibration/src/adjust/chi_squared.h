#pragma once

#include <cmath>

namespace wiimote_tracker::adjust {

/// Quantiles of the standard normal distribution.
constexpr double kTwoNines = 2.3263;    ///< 99 %
constexpr double kThreeNines = 3.0902;  ///< 99.9 %

/// Quantile of the chi-squared distribution (Wilson and Hilferty 1931). At 99 % it is within 0.8 %;
/// at 99.9 % too large by 3 % with one degree of freedom, 2 % with three, 1 % with six.
/// @param normal_quantile of the same probability.
inline double chiSquaredQuantile(double degrees_of_freedom, double normal_quantile) {
  const double spread = 2.0 / (9.0 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1.0 - spread + normal_quantile * std::sqrt(spread), 3);
}

}  // namespace wiimote_tracker::adjust
