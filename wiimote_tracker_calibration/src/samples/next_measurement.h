#pragma once

#include "samples/verdict.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::samples {

/// The measurement that lowers the expected error of points at some places most: a length between
/// two corners, or the LED on a known place. To first order: the joint covariance is updated by the
/// measurement, nothing is solved. Nothing when none gains 5 %.
/// @param found with a joint covariance. @param pixel standard deviation of a still LED, per axis
/// [px].
std::optional<NextMeasurement> nextMeasurement(const square::Solution& found,
                                               const square::SquareLayout& layout,
                                               const std::vector<Eigen::Vector3d>& places,
                                               double pixel);

}  // namespace wiimote_tracker::samples
