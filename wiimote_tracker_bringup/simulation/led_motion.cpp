#include "led_motion.h"

#include "wave_path.h"

#include <cmath>

namespace wiimote_tracker::simulation {
namespace {

/// The part of the way after a part of the time, both 0 to 1: the motion of a hand, which starts
/// and stops with the least jerk (Flash and Hogan 1985).
double wayOfHand(double time) {
  return time * time * time * (10.0 + time * (6.0 * time - 15.0));
}

}  // namespace

Eigen::Vector3d LedMotion::position(double time) const {
  if (time <= begin_ && time < arrival_)
    return from_;
  if (time < arrival_)
    return from_ + wayOfHand((time - begin_) / (arrival_ - begin_)) * (to_ - from_);
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
  const WavePath path(middle, sides, speed, seed);
  line(time, path.position(0.0), speed);
  then_ = [path](double since) { return path.position(since); };
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
