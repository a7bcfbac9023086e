#pragma once

#include "place/measure_place.h"

#include <Eigen/Core>

#include <string>

namespace wiimote_tracker::place {

/// A measured place compared with the known one.
struct PlaceCheck {
  double error = 0.0;            ///< Distance between both [m].
  double expected_stddev = 0.0;  ///< Of the error: root of the trace of its covariance [m].
  bool consistent = false;       ///< The covariance explains the error (chi-squared, 99 %).
  std::string message;           ///< One sentence: error, expected error, what to do.
};

/// @param known where the LED is, world [m]. @param known_stddev of that, per axis [m, >= 0].
/// @throws Error: values out of range or not finite.
void requirePlace(const Eigen::Vector3d& known, double known_stddev);

/// @param known and its standard deviation, as requirePlace() lets them pass.
PlaceCheck checkPlace(const MeasuredPlace& measured,
                      const Eigen::Vector3d& known,
                      double known_stddev);

}  // namespace wiimote_tracker::place
