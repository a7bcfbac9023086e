#include "clock_offset.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

void ClockOffset::add(const Eigen::Vector2d& velocity,
                      const Eigen::Vector2d& forward,
                      const Eigen::Vector2d& residual,
                      double correction) {
  // Spots of all LEDs; then all sums are halved, so that older ones count less: 5 to 10 s of one
  // LED, less of several. A clock that drifts by 100 ppm changes by less than 1 ms in that time.
  constexpr double kMost = 1000.0;
  if (count_ >= kMost) {
    for (double* sum : {&count_, &squared_velocity_, &squared_forward_, &squared_residual_,
                        &velocity_forward_, &velocity_residual_, &forward_residual_})
      *sum *= 0.5;
    for (Eigen::Vector2d* sum : {&velocity_, &forward_, &residual_})
      *sum *= 0.5;
  }
  const Eigen::Vector2d uncorrected = residual - correction * velocity;
  count_ += 1.0;
  velocity_ += velocity;
  forward_ += forward;
  residual_ += uncorrected;
  squared_velocity_ += velocity.squaredNorm();
  squared_forward_ += forward.squaredNorm();
  squared_residual_ += uncorrected.squaredNorm();
  velocity_forward_ += velocity.dot(forward);
  velocity_residual_ += velocity.dot(uncorrected);
  forward_residual_ += forward.dot(uncorrected);
}

ClockOffset::Estimate ClockOffset::estimate(double prior_stddev, double lag) const {
  // The noise is as if so many further spots were off by 1 px per axis.
  constexpr double kAssumed = 10.0;
  const double prior = prior_stddev * prior_stddev;
  if (!(count_ > 0.0 && prior > 0.0))
    return {0.0, prior};
  // residual = -offset * velocity + lag * forward + constant + noise, since a time that is too late
  // predicts the LED too far along its motion: regression on the velocity, both less their means.
  const Eigen::Vector2d sum = residual_ - lag * forward_;
  const double velocity_scatter =
      std::max(squared_velocity_ - velocity_.squaredNorm() / count_, 0.0);
  const double covariation =
      velocity_residual_ - lag * velocity_forward_ - velocity_.dot(sum) / count_;
  const double residual_scatter = squared_residual_ - 2.0 * lag * forward_residual_ +
                                  lag * lag * squared_forward_ - sum.squaredNorm() / count_;
  const double explained =
      velocity_scatter > 0.0 ? covariation * covariation / velocity_scatter : 0.0;
  const double noise =
      (std::max(residual_scatter - explained, 0.0) + 2.0 * kAssumed) / (2.0 * (count_ + kAssumed));
  const double information = velocity_scatter / noise + 1.0 / prior;
  return {-covariation / noise / information, 1.0 / information};
}

}  // namespace wiimote_tracker::tracking
