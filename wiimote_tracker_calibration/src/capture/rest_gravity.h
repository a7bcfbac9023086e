#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <optional>

namespace wiimote_tracker::capture {

/// Mean specific force of the accelerometer of a camera at rest. It points up.
class RestGravity {
 public:
  /// @param specific_force in the camera's optical frame [m/s^2].
  void add(const Eigen::Vector3d& specific_force) {
    if (!specific_force.allFinite())
      return;
    ++count_;
    const Eigen::Vector3d before = specific_force - mean_;
    mean_ += before / static_cast<double>(count_);
    sum_of_squares_ += before.dot(specific_force - mean_);
  }

  /// Mean [m/s^2], optical frame. Nothing with fewer than 20 readings, when they scatter by more
  /// than 0.5 m/s^2 (the camera is being moved), or when the mean is not 9.8 m/s^2 within 15 %.
  std::optional<Eigen::Vector3d> mean() const {
    constexpr double kStandardGravity = 9.81;
    constexpr double kTolerance = 0.15;  // accelerometers are off by several percent
    const double scatter = std::sqrt(sum_of_squares_ / static_cast<double>(count_));
    const double off = std::abs(mean_.norm() - kStandardGravity);
    if (count_ < 20 || scatter > 0.5 || off > kTolerance * kStandardGravity)
      return std::nullopt;
    return mean_;
  }

 private:
  std::size_t count_ = 0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  double sum_of_squares_ = 0.0;  // of the distances to the mean
};

}  // namespace wiimote_tracker::capture
