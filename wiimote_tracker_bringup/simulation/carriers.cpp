#include "carriers.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::simulation {

bool Cylinder::hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  // Seen from above: the part of the segment in the circle, as parameters s in [0, 1]. With
  // a = (to - from), b = (from - foot): |b + s a|^2 <= radius^2.
  const Eigen::Vector2d a = (to - from).head<2>();
  const Eigen::Vector2d b = (from - foot).head<2>();
  const double outside = b.squaredNorm() - radius * radius;
  double first = 0.0, last = 1.0;
  if (a.squaredNorm() > 0.0) {
    const double middle = -a.dot(b) / a.squaredNorm();
    const double squared = middle * middle - outside / a.squaredNorm();
    if (squared < 0.0)
      return false;
    first = std::max(first, middle - std::sqrt(squared));
    last = std::min(last, middle + std::sqrt(squared));
  } else if (outside > 0.0) {
    return false;
  }
  if (first > last)
    return false;
  const auto level = [&](double share) { return (from + share * (to - from)).z() - foot.z(); };
  return std::max(level(first), level(last)) >= 0.0 &&
         std::min(level(first), level(last)) <= height;
}

Eigen::Isometry3d worldFrom(const PersonDescription& carrier, double time) {
  Eigen::Vector3d place = carrier.motion.position(time);
  place.z() = 0.0;
  return Eigen::Translation3d(place) *
         Eigen::AngleAxisd(carrier.turn_rate * time, Eigen::Vector3d::UnitZ());
}

Eigen::Isometry3d worldFrom(const RigidBodyDescription& carrier, double time) {
  const TurningDescription& turning = carrier.turning;
  // The rates have no small common multiple, so that the motion does not repeat.
  const double phase = turning.sway_rate * time;
  return Eigen::Translation3d(carrier.motion.position(time)) *
         Eigen::AngleAxisd(turning.rate * time, turning.axis.normalized()) *
         Eigen::AngleAxisd(turning.sway * std::sin(phase), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(0.6 * turning.sway * std::sin(1.89 * phase), Eigen::Vector3d::UnitX());
}

Cylinder cylinderOf(const PersonDescription& person, double time) {
  return {worldFrom(person, time).translation(), person.radius, person.height};
}

}  // namespace wiimote_tracker::simulation
