#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_RIGID_BODY_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_RIGID_BODY_H

#include "description.h"
#include "led_motion.h"

#include <Eigen/Geometry>

#include <string>

namespace wiimote_tracker::simulation {

/// A moving rigid body with LEDs. It occludes nothing.
class RigidBody {
 public:
  explicit RigidBody(const RigidBodyDescription& description)
      : motion(description.motion), present(description.present), description_(description) {}

  const std::string& name() const { return description_.name; }

  /// Its axes are parallel to the world's at time 0.
  Eigen::Isometry3d worldFromBody(double time) const;

  LedMotion motion;  ///< Of its origin.
  bool present;      ///< If absent, its LEDs are not seen.

 private:
  RigidBodyDescription description_;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_RIGID_BODY_H
