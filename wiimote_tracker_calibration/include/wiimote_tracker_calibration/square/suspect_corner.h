#pragma once

#include "wiimote_tracker_calibration/square/square_layout.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace wiimote_tracker::square {

/// A corner that the LED was probably not put on.
struct SuspectCorner {
  std::size_t corner = 0;  ///< 0..3.
  double distance = 0.0;   ///< From where it should have been, by the other data [m].
  /// Decrease of chi-squared (two degrees of freedom) without the prior of this corner's place.
  double chi_squared = 0.0;
  /// The second best corner, and how much smaller its decrease is.
  std::optional<std::size_t> runner_up;
  double lead = 0.0;
};

/// The corner whose prior place contradicts the other data most. Without the prior that the LED was
/// put there within `placement`, the other data determine where it was: deletion of one observation
/// (Cook and Weisberg, Residuals and Influence in Regression, 1982).
/// @param offsets horizontal displacement of the corners from the layout, as estimated [m].
/// @param joint_covariance its last kCornerParameters rows and columns are of these [m^2].
/// @param placement standard deviation of every corner, per axis [m, > 0].
/// @returns nothing when the other data determine no corner.
std::optional<SuspectCorner> suspectCorner(const Corners& offsets,
                                           const Eigen::MatrixXd& joint_covariance,
                                           double placement);

/// Whether it is significant: one in 2500 calibrations has such a corner by chance.
bool isDisplaced(const SuspectCorner& suspect);

}  // namespace wiimote_tracker::square
