#include "led_motion.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>

namespace wiimote_tracker::simulation {
namespace {

/// Minimum-jerk motion, as of a hand (Flash and Hogan 1985): the share of the way after a share of
/// the time.
double minimumJerk(double time) {
  return time * time * time * (10.0 + time * (6.0 * time - 15.0));
}

/// See LedMotion::wave(): two oscillations of incommensurable periods per axis.
LedMotion::Path wavePath(const Eigen::Vector3d& middle,
                         const Eigen::Vector3d& sides,
                         double speed,
                         std::uint32_t seed) {
  constexpr int kParts = 2;
  constexpr std::array<double, kParts> kShares{0.7, 0.3};  // of half a side; their sum is 1
  std::mt19937 random(seed);
  // Not std::uniform_real_distribution, whose numbers depend on the library.
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  Eigen::Matrix<double, 3, kParts> amplitude;  // [m]
  Eigen::Matrix<double, 3, kParts> frequency;  // [rad/s]
  Eigen::Matrix<double, 3, kParts> phase;      // [rad]
  for (int axis = 0; axis < 3; ++axis) {
    for (int part = 0; part < kParts; ++part) {
      amplitude(axis, part) = 0.5 * sides(axis) * kShares[static_cast<std::size_t>(part)];
      frequency(axis, part) = part == 0 ? between(0.7, 1.3) : between(1.7, 2.7);
      phase(axis, part) = between(0.0, 2.0 * M_PI);
    }
  }
  // The mean square of a cosine is 1/2.
  frequency *= speed / std::sqrt(0.5 * amplitude.cwiseProduct(frequency).squaredNorm());
  return [=](double time) -> Eigen::Vector3d {
    return middle + amplitude.cwiseProduct((frequency * time + phase).array().sin().matrix())
                        .rowwise()
                        .sum();
  };
}

}  // namespace

Eigen::Vector3d LedMotion::position(double time) const {
  if (time <= begin_ && time < arrival_)
    return from_;
  if (time < arrival_)
    return from_ + minimumJerk((time - begin_) / (arrival_ - begin_)) * (to_ - from_);
  return then_ ? then_(time - arrival_) : to_;
}

void LedMotion::hold(double time) {
  line(time, position(time), 0.0);
}

double LedMotion::line(double time, const Eigen::Vector3d& target, double speed) {
  from_ = position(time);
  to_ = target;
  begin_ = time;
  arrival_ = speed > 0.0 ? time + (to_ - from_).norm() / speed : time;
  then_ = nullptr;
  drawing_end_ = -1.0;
  return arrival_;
}

double LedMotion::circle(double time, const Eigen::Vector3d& center, double radius, double speed) {
  line(time, center + radius * Eigen::Vector3d::UnitX(), speed);
  then_ = [=](double since) -> Eigen::Vector3d {
    const double angle = speed / radius * since;
    return center + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  };
  return arrival_;
}

double LedMotion::wave(double time,
                       const Eigen::Vector3d& middle,
                       const Eigen::Vector3d& sides,
                       double speed,
                       std::uint32_t seed) {
  const Path path = wavePath(middle, sides, speed, seed);
  line(time, path(0.0), speed);
  then_ = path;
  return arrival_;
}

double LedMotion::draw(double time,
                       const Drawing& drawing,
                       const Eigen::Vector3d& middle,
                       double speed) {
  line(time, middle + drawing.position(0.0), speed);
  then_ = [=](double since) -> Eigen::Vector3d {
    return middle + drawing.position(since - drawing.rest());
  };
  drawing_begin_ = arrival_ + drawing.rest();
  drawing_end_ = drawing_begin_ + drawing.duration();
  return drawing_begin_;
}

bool LedMotion::isDrawing(double time) const {
  return drawing_begin_ <= time && time <= drawing_end_;
}

}  // namespace wiimote_tracker::simulation
