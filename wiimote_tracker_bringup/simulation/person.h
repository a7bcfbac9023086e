#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_PERSON_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_PERSON_H

#include "description.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wiimote_tracker::simulation {

/// An upright cylinder that no light passes.
struct Pillar {
  Eigen::Vector3d foot;  ///< Centre of the lower end, world [m].
  double radius;         ///< [m]
  double height;         ///< [m]

  /// Whether it stands in the way from one place to the other [m].
  bool hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

/// Somebody in the room, who walks, turns, is in the light's way, and may carry LEDs.
class Person {
 public:
  explicit Person(const PersonDescription& description)
      : motion(description.motion), present(description.present), description_(description) {}

  const std::string& name() const { return description_.name; }

  /// The axes in which carried LEDs move: origin on the floor, x where the person faces (along the
  /// world's x at time 0), z up.
  Eigen::Isometry3d worldFromPerson(double time) const;

  Pillar body(double time) const;

  LedMotion motion;  ///< Where they walk; its z is not read.
  bool present;      ///< Who is away hides nothing, and what they carry is not seen.

 private:
  PersonDescription description_;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_PERSON_H
