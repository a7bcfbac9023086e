#pragma once

#include "description.h"
#include "led_board.h"
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
  double due;       ///< When its report arrives [s since the start].
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

  /// These may be changed in how they move or look, and whether they are lit or present; null:
  /// there is no such thing. Call runUntil() with the time of a change first.
  LedDescription* findLed(const std::string& name) { return findNamed(description_.leds, name); }
  PersonDescription* findPerson(const std::string& name) {
    return findNamed(description_.people, name);
  }
  RigidBodyDescription* findBody(const std::string& name) {
    return findNamed(description_.bodies, name);
  }
  ReflectionDescription* findReflection(const std::string& name) {
    return findNamed(description_.reflections, name);
  }
  VirtualCamera* findCamera(const std::string& name);
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
    VirtualCamera optics;
    virtual_wiimote::FrameTimes times;
    virtual_wiimote::FrameTime next;
    std::queue<Image> travelling;
  };

  Eigen::Vector3d positionOf(const LedDescription& led, double time) const;
  bool isInRoom(const LedDescription& led) const;
  void push(double time, Event::Kind kind, std::size_t camera);
  void expose(std::size_t number);
  void tellTruth(double time);

  Deliver deliver_;
  Truth truth_;
  BodyTruth body_truth_;  ///< May be empty.
  Description description_;
  std::uint64_t truths_ = 0;
  std::vector<Camera> cameras_;
  std::optional<LedBoard> board_;
  std::vector<Lamp> lamps_;  // reused, as is bodies_
  std::vector<Cylinder> bodies_;
  std::priority_queue<Event, std::vector<Event>, std::greater<Event>> events_;
  std::uint64_t event_count_ = 0;
};

}  // namespace wiimote_tracker::simulation
