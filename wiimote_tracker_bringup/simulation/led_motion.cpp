#include "led_motion.h"

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
  if (wave_)
    return wave_->position(time - arrival_);
  if (drawing_)
    return middle_ + drawing_->position(time - arrival_ - drawing_->rest());
  const double angle = angular_speed_ * (time - arrival_);
  return to_ + radius_ * Eigen::Vector3d(std::cos(angle) - 1.0, std::sin(angle), 0.0);
}

void LedMotion::hold(double time) {
  line(time, position(time), 0.0);
}

double LedMotion::line(double time, const Eigen::Vector3d& target, double speed) {
  from_ = position(time);
  to_ = target;
  begin_ = time;
  arrival_ = speed > 0.0 ? time + (to_ - from_).norm() / speed : time;
  radius_ = 0.0;
  angular_speed_ = 0.0;
  wave_.reset();
  drawing_.reset();
  return arrival_;
}

double LedMotion::circle(double time, const Eigen::Vector3d& center, double radius, double speed) {
  line(time, center + radius * Eigen::Vector3d::UnitX(), speed);
  radius_ = radius;
  angular_speed_ = speed / radius;
  return arrival_;
}

double LedMotion::wave(double time,
                       const Eigen::Vector3d& middle,
                       const Eigen::Vector3d& sides,
                       double speed,
                       std::uint32_t seed) {
  const WavePath path(middle, sides, speed, seed);
  line(time, path.position(0.0), speed);
  wave_ = path;
  return arrival_;
}

double LedMotion::draw(double time,
                       const Drawing& drawing,
                       const Eigen::Vector3d& middle,
                       double speed) {
  line(time, middle + drawing.position(0.0), speed);
  drawing_ = drawing;
  middle_ = middle;
  return arrival_ + drawing.rest();
}

bool LedMotion::isDrawing(double time) const {
  if (!drawing_)
    return false;
  const double since = time - arrival_ - drawing_->rest();
  return 0.0 <= since && since <= drawing_->duration();
}

}  // namespace wiimote_tracker::simulation
