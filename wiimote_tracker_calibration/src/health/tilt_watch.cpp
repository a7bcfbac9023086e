#include "health/tilt_watch.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::health {

Tilt tiltOf(const Eigen::Vector3d& before, const Eigen::Vector3d& now, const TiltOptions& options) {
  Tilt tilt;
  tilt.angle = std::atan2(before.cross(now).norm(), before.dot(now));
  // Rounding, at calibration and now. Averaged noise is far smaller.
  tilt.stddev = options.resolution / std::sqrt(12.0) * std::sqrt(2.0) / before.norm();
  tilt.ratio = tilt.angle / std::max(options.limit, 3.0 * tilt.stddev);
  return tilt;
}

std::optional<Tilt> TiltWatch::add(double time, const Eigen::Vector3d& specific_force) {
  std::optional<Tilt> tilt;
  const bool is_over = time - start_ >= options_.window;
  if (time >= last_ && is_over)
    tilt = judge();
  if (time < last_ || is_over) {
    start_ = time;
    window_ = capture::RestGravity();
  }
  last_ = time;
  window_.add(specific_force);
  return tilt;
}

std::optional<Tilt> TiltWatch::judge() const {
  const auto mean = window_.mean();
  if (!mean)
    return std::nullopt;
  return tiltOf(gravity_, *mean, options_);
}

}  // namespace wiimote_tracker::health
