#pragma once

#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <Eigen/Core>

#include <array>
#include <string>

namespace wiimote_tracker::intrinsics {

/// Homography from the board to the image: what is known of a view without knowing the lens.
struct ViewGeometry {
  std::array<Eigen::Vector2d, 4> corners;  ///< Of the board: LEDs 0, 3, 15, 12, seen or not [px].

  Eigen::Vector2d center() const;
  double size() const;  ///< Square root of the area [px].
  double skew() const;  ///< How far the angle at LED 3 is from a right one [rad].
};

/// @throws Error: fewer than six LEDs, pixels not finite, or all in one line; the LEDs are no grid,
/// or mirrored: wrong wiring or numbers. The sentence begins with `name`.
ViewGeometry viewGeometry(const Board& board, const BoardView& view, const std::string& name);

}  // namespace wiimote_tracker::intrinsics
