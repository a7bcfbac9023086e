#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_RIG_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_RIG_H

#include "description.h"
#include "led_board.h"
#include "led_motion.h"
#include "person.h"
#include "virtual_camera.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <functional>
#include <optional>
#include <queue>
#include <string>
#include <vector>

namespace wiimote_tracker::simulation {

/// Input of a camera's sensor for one image.
struct Image : virtual_wiimote::Senses {
  double exposure;  ///< Time [s since the start].
};

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

/// A queue of the events of a description: exposures, deliveries of reports, instants of truth.
/// Reads no clock: the caller sets the time. The events depend on the description and the motions
/// only, not on the time steps.
class Rig {
 public:
  /// Receives an image of camera number `camera` when its report is due.
  using Deliver = std::function<void(std::size_t camera, const Image& image)>;
  /// Receives the true position [m] of LED number `led` at `time` [s].
  using Truth = std::function<void(std::size_t led, double time, const Eigen::Vector3d& position)>;

  /// Receives the true pose [m] of rigid body number `body` at `time` [s].
  using BodyTruth =
      std::function<void(std::size_t body, double time, const Eigen::Isometry3d& pose)>;

  Rig(const Description& description, Deliver deliver, Truth truth, BodyTruth body_truth = {});

  /// Executes all events up to and including `time` [s since the start], in order.
  void runUntil(double time);

  /// Time of the next event [s].
  double nextEvent() const { return events_.top().time; }

  /// State of an LED. Call runUntil() with the time of a change first. Null if there is no such
  /// LED.
  struct Led {
    LedDescription description;
    LedMotion motion;  ///< Ignored for an LED that turns; in the carrier's axes if carried.
    bool lit;
  };
  Led* findLed(const std::string& name);

  /// A person, or null. Call runUntil() with the time of a change first.
  Person* findPerson(const std::string& name);

  /// A rigid body, or null. Call runUntil() with the time of a change first.
  RigidBody* findBody(const std::string& name);

  /// A reflection, or null; its `lit` may be changed. Call runUntil() with the time of a change
  /// first.
  ReflectionDescription* findReflection(const std::string& name);

  /// The board, or null. Call runUntil() with the time of a change first.
  LedBoard* board() { return board_ ? &*board_ : nullptr; }

 private:
  struct Event {
    enum Kind { kExposure, kDelivery, kTruth };
    double time;
    Kind kind;
    std::size_t camera;
    std::uint64_t number;  ///< Order among events of one time.

    bool operator>(const Event& other) const {
      return time != other.time ? time > other.time : number > other.number;
    }
  };

  struct Camera {
    std::string name;
    VirtualCamera optics;
    virtual_wiimote::FrameTimes times;
    virtual_wiimote::FrameTime next;
    std::queue<Image> travelling;
  };

  Eigen::Vector3d positionOf(const Led& led, double time) const;
  bool isInRoom(const Led& led) const;
  void push(double time, Event::Kind kind, std::size_t camera);
  void expose(std::size_t number);
  void tellTruth(double time);

  Deliver deliver_;
  Truth truth_;
  BodyTruth body_truth_;  ///< May be empty.
  double truth_period_;
  std::uint64_t truths_ = 0;
  std::vector<Camera> cameras_;
  std::vector<Led> leds_;
  std::vector<Person> people_;
  std::vector<RigidBody> rigid_bodies_;
  std::vector<ReflectionDescription> reflections_;
  std::optional<LedBoard> board_;
  std::vector<Lamp> lamps_;  // reused, as are bodies_ and reflected_
  std::vector<Cylinder> bodies_;
  std::vector<ReflectedLight> reflected_;
  std::priority_queue<Event, std::vector<Event>, std::greater<Event>> events_;
  std::uint64_t event_count_ = 0;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_RIG_H
