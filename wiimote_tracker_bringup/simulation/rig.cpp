#include "rig.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

Rig::Rig(const Description& description, Deliver deliver, Truth truth, BodyTruth body_truth)
    : deliver_(std::move(deliver)),
      truth_(std::move(truth)),
      body_truth_(std::move(body_truth)),
      truth_period_(1.0 / description.truth_rate),
      people_(description.people.begin(), description.people.end()),
      rigid_bodies_(description.bodies.begin(), description.bodies.end()),
      reflections_(description.reflections) {
  for (const LedDescription& led : description.leds)
    leds_.push_back({led, led.motion, led.lit});
  for (const CameraDescription& camera : description.cameras) {
    // Separate seeds for each camera's pixels and link.
    const auto number = static_cast<std::uint32_t>(cameras_.size());
    std::seed_seq sequence{description.seed, number};
    std::uint32_t seeds[2];
    sequence.generate(seeds, seeds + 2);
    virtual_wiimote::FrameTimes times(camera.timing, seeds[1]);
    const virtual_wiimote::FrameTime first = times.next();
    cameras_.push_back({camera.camera.name,
                        VirtualCamera(camera.camera, description.pixel_noise, seeds[0]),
                        times,
                        first,
                        {}});
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

Rig::Led* Rig::findLed(const std::string& name) {
  for (Led& led : leds_) {
    if (led.description.name == name)
      return &led;
  }
  return nullptr;
}

Person* Rig::findPerson(const std::string& name) {
  for (Person& person : people_) {
    if (person.name() == name)
      return &person;
  }
  return nullptr;
}

RigidBody* Rig::findBody(const std::string& name) {
  for (RigidBody& body : rigid_bodies_) {
    if (body.name() == name)
      return &body;
  }
  return nullptr;
}

ReflectionDescription* Rig::findReflection(const std::string& name) {
  for (ReflectionDescription& reflection : reflections_) {
    if (reflection.name == name)
      return &reflection;
  }
  return nullptr;
}

bool Rig::isInRoom(const Led& led) const {
  const auto isAwayWith = [&](const auto& carrier) {
    return carrier.name() == led.description.carried_by && !carrier.present;
  };
  return std::none_of(people_.begin(), people_.end(), isAwayWith) &&
         std::none_of(rigid_bodies_.begin(), rigid_bodies_.end(), isAwayWith);
}

Eigen::Vector3d Rig::positionOf(const Led& led, double time) const {
  for (const Person& person : people_) {
    if (person.name() == led.description.carried_by)
      return person.worldFromPerson(time) * led.motion.position(time);
  }
  for (const RigidBody& body : rigid_bodies_) {
    if (body.name() == led.description.carried_by)
      return body.worldFromBody(time) * led.motion.position(time);
  }
  if (!led.description.turns)
    return led.motion.position(time);
  const TurnDescription& turns = *led.description.turns;
  const auto around = std::find_if(leds_.begin(), leds_.end(), [&](const Led& other) {
    return other.description.name == turns.around;
  });
  const Eigen::Vector3d center = positionOf(*around, time);
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
  for (const Led& led : leds_) {
    const std::optional<Blink>& blink = led.description.blink;
    const double light = blink ? blink->light(time) : 1.0;
    if ((led.lit || led.motion.isDrawing(time)) && isInRoom(led) && light > 0.0)
      lamps_.push_back(
          {positionOf(led, time), led.description.size, light * led.description.brightness});
  }
  if (board_)
    board_->addLamps(time, &lamps_);
  bodies_.clear();
  for (const Person& person : people_) {
    if (person.present)
      bodies_.push_back(person.body(time));
  }
  reflected_.clear();
  for (const ReflectionDescription& reflection : reflections_) {
    if (reflection.lit && reflection.camera == camera.name)
      reflected_.push_back({reflection.pixel, reflection.size, reflection.brightness});
  }
  const Image image{camera.optics.sense(lamps_, bodies_, reflected_), time};
  if (!camera.next.lost) {
    camera.travelling.push(image);
    push(camera.next.arrival, Event::kDelivery, number);
  }
  camera.next = camera.times.next();
  push(camera.next.exposure, Event::kExposure, number);
}

void Rig::tellTruth(double time) {
  for (std::size_t i = 0; i < leds_.size(); ++i)
    truth_(i, time, positionOf(leds_[i], time));
  for (std::size_t i = 0; body_truth_ && i < rigid_bodies_.size(); ++i)
    body_truth_(i, time, rigid_bodies_[i].worldFromBody(time));
  push(static_cast<double>(++truths_) * truth_period_, Event::kTruth, 0);
}

}  // namespace wiimote_tracker::simulation
