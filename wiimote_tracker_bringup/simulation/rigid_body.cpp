#include "rigid_body.h"

#include <cmath>

namespace wiimote_tracker::simulation {

Eigen::Isometry3d RigidBody::worldFromBody(double time) const {
  const TurningDescription& turning = description_.turning;
  // The rates have no small common multiple, so that the motion does not repeat.
  const double phase = turning.sway_rate * time;
  return Eigen::Translation3d(motion.position(time)) *
         Eigen::AngleAxisd(turning.rate * time, turning.axis.normalized()) *
         Eigen::AngleAxisd(turning.sway * std::sin(phase), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(0.6 * turning.sway * std::sin(1.89 * phase), Eigen::Vector3d::UnitX());
}

}  // namespace wiimote_tracker::simulation
