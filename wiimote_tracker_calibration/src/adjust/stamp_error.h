#pragma once

#include <algorithm>

namespace wiimote_tracker::adjust {

/// Variance of the mean of the slow errors of a camera's stamps, a first-order Gauss-Markov
/// process, over a time much longer than its correlation time of 2 s [s^2].
/// @param wander standard deviation of the errors [s]. @param duration [s]
inline double meanStampVariance(double wander, double duration) {
  const double kCorrelationTime = 2.0;  // [s]
  return wander * wander * std::min(1.0, 2.0 * kCorrelationTime / duration);
}

}  // namespace wiimote_tracker::adjust
