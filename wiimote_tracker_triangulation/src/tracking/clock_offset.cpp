#include "clock_offset.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

void ClockOffset::add(const Eigen::Vector2d& velocity, const Eigen::Vector2d& residual) {
  count_ += 1.0;
  velocity_ += velocity;
  residual_ += residual;
  squared_velocity_ += velocity.squaredNorm();
  squared_residual_ += residual.squaredNorm();
  velocity_residual_ += velocity.dot(residual);
}

std::optional<ClockOffset::Estimate> ClockOffset::estimate() const {
  // The noise is as if so many further spots were off by 1 px per axis.
  constexpr double kAssumed = 10.0;
  // residual = -offset * velocity + constant + noise, since a time that is too late predicts the
  // LED too far along its motion: regression on the velocity, both less their means.
  const double velocity_scatter = squared_velocity_ - velocity_.squaredNorm() / count_;
  if (!(count_ > 0.0 && velocity_scatter > 0.0))
    return std::nullopt;
  const double covariation = velocity_residual_ - velocity_.dot(residual_) / count_;
  const double unexplained = squared_residual_ - residual_.squaredNorm() / count_ -
                             covariation * covariation / velocity_scatter;
  const double noise = (std::max(unexplained, 0.0) + 2.0 * kAssumed) / (2.0 * (count_ + kAssumed));
  return Estimate{-covariation / velocity_scatter, noise / velocity_scatter};
}

}  // namespace wiimote_tracker::tracking
