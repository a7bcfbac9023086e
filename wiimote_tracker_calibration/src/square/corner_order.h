#pragma once

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::square {

/// How the corners lie in one image.
enum class CornerOrder {
  kCounterClockwise,  ///< As a viewer sees them who looks at the floor from the camera.
  kClockwise,
  kCoincident,  ///< Two corners in one place.
  kCollinear,   ///< Three corners on one line.
  kCrossing,    ///< The sides cross: the corners were not taken round the square.
  kNotConvex,   ///< One corner inside the triangle of the others: no view of a rectangle.
};

/// @param pixels three or four places without lens distortion, v down [px].
CornerOrder cornerOrder(const std::vector<Eigen::Vector2d>& pixels);

}  // namespace wiimote_tracker::square
