#include "wiimote_tracker_calibration/square/corner_order.h"

#include <algorithm>

namespace wiimote_tracker::square {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

CornerOrder cornerOrder(const std::array<Eigen::Vector2d, 4>& pixels, double tolerance) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      if ((pixels[i] - pixels[j]).norm() < tolerance)
        return CornerOrder::kCoincident;
    }
  }

  // Turn at each corner: positive is clockwise for the viewer, because v points down.
  int clockwise = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& before = pixels[(i + 3) % 4];
    const Eigen::Vector2d& after = pixels[(i + 1) % 4];
    const double area = cross(pixels[i] - before, after - pixels[i]);
    const double longest = std::max(
        {(pixels[i] - before).norm(), (after - pixels[i]).norm(), (after - before).norm()});
    if (std::abs(area) / longest < tolerance)
      return CornerOrder::kCollinear;
    clockwise += area > 0.0;
  }
  switch (clockwise) {
    case 0:
      return CornerOrder::kCounterClockwise;
    case 2:
      return CornerOrder::kCrossing;
    case 4:
      return CornerOrder::kClockwise;
    default:
      return CornerOrder::kNotConvex;
  }
}

}  // namespace wiimote_tracker::square
