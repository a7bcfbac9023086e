#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_PERSON_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_PERSON_H

#include "description.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wiimote_tracker::simulation {

/// An upright opaque cylinder.
struct Cylinder {
  Eigen::Vector3d foot;  ///< Centre of the lower end, world [m].
  double radius;         ///< [m]
  double height;         ///< [m]

  /// Whether it intersects the segment between two points [m].
  bool hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

/// A person in the room, who walks, turns, occludes LEDs, and may carry some.
class Person {
 public:
  explicit Person(const PersonDescription& description)
      : motion(description.motion), present(description.present), description_(description) {}

  const std::string& name() const { return description_.name; }

  /// The axes of carried LEDs: origin on the floor, x forward (along the world's x at time 0), z
  /// up.
  Eigen::Isometry3d worldFromPerson(double time) const;

  Cylinder body(double time) const;

  LedMotion motion;  ///< On the floor; z is ignored.
  bool present;      ///< If absent, occludes nothing, and carried LEDs are not seen.

 private:
  PersonDescription description_;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_PERSON_H
