#include "capture/still_spot.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace wiimote_tracker::capture {

void StillSpot::add(const Eigen::Vector2d& pixel) {
  pixels_.push_back(pixel);
  const Eigen::Vector2d before = pixel - mean_;
  mean_ += before / static_cast<double>(pixels_.size());
  sum_of_squares_ += before.dot(pixel - mean_);
}

double StillSpot::spread() const {
  if (pixels_.size() < 2)
    return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(sum_of_squares_ / static_cast<double>(pixels_.size() - 1));
}

double StillSpot::drift() const {
  if (pixels_.size() < 9)
    return 0.0;
  const auto third = static_cast<std::ptrdiff_t>(pixels_.size() / 3);
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  const Eigen::Vector2d first = std::accumulate(pixels_.begin(), pixels_.begin() + third, zero);
  const Eigen::Vector2d last = std::accumulate(pixels_.end() - third, pixels_.end(), zero);
  return (last - first).norm() / static_cast<double>(third);
}

}  // namespace wiimote_tracker::capture
