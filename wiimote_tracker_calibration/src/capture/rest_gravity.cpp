#include "capture/rest_gravity.h"

#include <cmath>

namespace wiimote_tracker::capture {

namespace {

constexpr std::size_t kMinimumReadings = 20;
constexpr double kScatterLimit = 0.5;      // [m/s^2]
constexpr double kStandardGravity = 9.81;  // [m/s^2]
constexpr double kTolerance = 0.15;        // accelerometers are off by several percent

}  // namespace

void RestGravity::add(const Eigen::Vector3d& specific_force) {
  if (!specific_force.allFinite())
    return;
  ++count_;
  const Eigen::Vector3d before = specific_force - mean_;
  mean_ += before / static_cast<double>(count_);
  sum_of_squares_ += before.dot(specific_force - mean_);
}

std::optional<Eigen::Vector3d> RestGravity::mean() const {
  if (count_ < kMinimumReadings)
    return std::nullopt;
  if (std::sqrt(sum_of_squares_ / static_cast<double>(count_)) > kScatterLimit)
    return std::nullopt;
  if (std::abs(mean_.norm() - kStandardGravity) > kTolerance * kStandardGravity)
    return std::nullopt;
  return mean_;
}

}  // namespace wiimote_tracker::capture
