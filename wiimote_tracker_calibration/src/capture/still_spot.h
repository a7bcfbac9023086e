#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace wiimote_tracker::capture {

/// Positions of one spot in successive images of one camera, and how still it was.
class StillSpot {
 public:
  void add(const Eigen::Vector2d& pixel) {
    pixels_.push_back(pixel);
    const Eigen::Vector2d before = pixel - mean_;
    mean_ += before / static_cast<double>(pixels_.size());
    sum_of_squares_ += before.dot(pixel - mean_);
  }

  std::size_t samples() const { return pixels_.size(); }

  /// Mean position [px]; zero without samples.
  const Eigen::Vector2d& mean() const { return mean_; }

  /// Standard deviation over both axes together, sqrt(var_u + var_v) [px]; NaN below two samples.
  double spread() const {
    if (pixels_.size() < 2)
      return std::numeric_limits<double>::quiet_NaN();
    return std::sqrt(sum_of_squares_ / static_cast<double>(pixels_.size() - 1));
  }

  /// Distance between the means of the first and the last third of the samples [px]: finds motion
  /// too slow for the spread. Zero below nine samples.
  double drift() const {
    if (pixels_.size() < 9)
      return 0.0;
    const auto third = static_cast<std::ptrdiff_t>(pixels_.size() / 3);
    const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
    const Eigen::Vector2d first = std::accumulate(pixels_.begin(), pixels_.begin() + third, zero);
    const Eigen::Vector2d last = std::accumulate(pixels_.end() - third, pixels_.end(), zero);
    return (last - first).norm() / static_cast<double>(third);
  }

 private:
  std::vector<Eigen::Vector2d> pixels_;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
  double sum_of_squares_ = 0.0;  // of the distances to the mean
};

}  // namespace wiimote_tracker::capture
