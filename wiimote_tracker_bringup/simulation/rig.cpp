#include "rig.h"

#include <cmath>
#include <utility>

namespace wiimote_tracker::simulation {

Rig::Rig(const Description& description, Deliver deliver, Truth truth, BodyTruth body_truth)
    : deliver_(std::move(deliver)),
      truth_(std::move(truth)),
      body_truth_(std::move(body_truth)),
      description_(description) {
  for (const CameraDescription& camera : description.cameras) {
    // Separate seeds for each camera's pixels and link.
    const auto number = static_cast<std::uint32_t>(cameras_.size());
    std::seed_seq sequence{description.seed, number};
    std::uint32_t seeds[2];
    sequence.generate(seeds, seeds + 2);
    virtual_wiimote::FrameTimes times(camera.timing, seeds[1]);
    const virtual_wiimote::FrameTime first = times.next();
    cameras_.push_back(
        {VirtualCamera(camera.camera, description.pixel_noise, seeds[0]), times, first, {}});
    push(first.exposure, Event::kExposure, number);
    if (description.board && description.board->before == camera.camera.name)
      board_.emplace(*description.board, camera.camera);
  }
  push(0.0, Event::kTruth, 0);
}

void Rig::runUntil(double time) {
  while (events_.top().time <= time) {
    const Event event = events_.top();
    events_.pop();
    switch (event.kind) {
      case Event::kExposure:
        expose(event.camera);
        break;
      case Event::kDelivery:
        deliver_(event.camera, cameras_[event.camera].travelling.front());
        cameras_[event.camera].travelling.pop();
        break;
      case Event::kTruth:
        tellTruth(event.time);
        break;
    }
  }
}

VirtualCamera* Rig::findCamera(const std::string& name) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (description_.cameras[i].camera.name == name)
      return &cameras_[i].optics;
  }
  return nullptr;
}

bool Rig::isInRoom(const LedDescription& led) const {
  if (led.turns)
    return isInRoom(*findNamed(description_.leds, led.turns->around));
  const PersonDescription* person = findNamed(description_.people, led.carried_by);
  const RigidBodyDescription* body = findNamed(description_.bodies, led.carried_by);
  return (!person || person->present) && (!body || body->present);
}

Eigen::Vector3d Rig::positionOf(const LedDescription& led, double time) const {
  if (const PersonDescription* person = findNamed(description_.people, led.carried_by))
    return worldFrom(*person, time) * led.motion.position(time);
  if (const RigidBodyDescription* body = findNamed(description_.bodies, led.carried_by))
    return worldFrom(*body, time) * led.motion.position(time);
  if (!led.turns)
    return led.motion.position(time);
  const TurnDescription& turns = *led.turns;
  const Eigen::Vector3d center = positionOf(*findNamed(description_.leds, turns.around), time);
  if (center.z() <= 0.0)
    return center + turns.distance * Eigen::Vector3d::UnitX();
  constexpr double kNod = 0.618;     // irrational, so that turns do not repeat
  constexpr double kSteepest = 1.0;  // [rad]
  const double azimuth = turns.rate * time;
  const double elevation = kSteepest * std::sin(kNod * azimuth);
  return center + turns.distance * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                   std::cos(elevation) * std::sin(azimuth),
                                                   std::sin(elevation));
}

void Rig::push(double time, Event::Kind kind, std::size_t camera) {
  events_.push({time, kind, camera, event_count_++});
}

void Rig::expose(std::size_t number) {
  Camera& camera = cameras_[number];
  const double time = camera.next.exposure;
  lamps_.clear();
  for (const LedDescription& led : description_.leds) {
    const double light = led.blink ? led.blink->light(time) : 1.0;
    if ((led.lit || led.motion.isDrawing(time)) && isInRoom(led) && light > 0.0)
      lamps_.push_back({positionOf(led, time), led.size, light * led.brightness});
  }
  if (board_)
    board_->addLamps(time, &lamps_);
  bodies_.clear();
  for (const PersonDescription& person : description_.people) {
    if (person.present)
      bodies_.push_back(cylinderOf(person, time));
  }
  const Image image{camera.optics.sense(lamps_, bodies_, description_.reflections), time,
                    camera.next.arrival};
  if (!camera.next.lost) {
    camera.travelling.push(image);
    push(image.due, Event::kDelivery, number);
  }
  camera.next = camera.times.next();
  push(camera.next.exposure, Event::kExposure, number);
}

void Rig::tellTruth(double time) {
  for (std::size_t i = 0; i < description_.leds.size(); ++i)
    truth_(i, time, positionOf(description_.leds[i], time));
  for (std::size_t i = 0; body_truth_ && i < description_.bodies.size(); ++i)
    body_truth_(i, time, worldFrom(description_.bodies[i], time));
  push(static_cast<double>(++truths_) / description_.truth_rate, Event::kTruth, 0);
}

}  // namespace wiimote_tracker::simulation
