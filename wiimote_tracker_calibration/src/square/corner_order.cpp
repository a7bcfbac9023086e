#include "square/corner_order.h"

#include <algorithm>

namespace wiimote_tracker::square {

namespace {

// Nearer than this in an image, points are one point or one line [px].
constexpr double kTolerance = 3.0;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

CornerOrder cornerOrder(const std::vector<Eigen::Vector2d>& pixels) {
  const std::size_t count = pixels.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      if ((pixels[i] - pixels[j]).norm() < kTolerance)
        return CornerOrder::kCoincident;
    }
  }

  // Turn at each corner: positive is clockwise for the viewer, because v points down.
  std::size_t clockwise = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d& before = pixels[(i + count - 1) % count];
    const Eigen::Vector2d& after = pixels[(i + 1) % count];
    const double area = cross(pixels[i] - before, after - pixels[i]);
    const double longest = std::max(
        {(pixels[i] - before).norm(), (after - pixels[i]).norm(), (after - before).norm()});
    if (std::abs(area) / longest < kTolerance)
      return CornerOrder::kCollinear;
    clockwise += area > 0.0;
  }
  if (clockwise == 0)
    return CornerOrder::kCounterClockwise;
  if (clockwise == count)
    return CornerOrder::kClockwise;
  return clockwise == 2 ? CornerOrder::kCrossing : CornerOrder::kNotConvex;
}

}  // namespace wiimote_tracker::square
