#include "body/body_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::body {
namespace {

/// Of a camera's time offset, with which images before and after it cannot be combined [s].
constexpr double kOffsetJump = 0.05;

double offsetOf(const geometry::RigCamera& camera) {
  return camera.time_offset_rule == geometry::TimeOffsetRule::kNone ? 0.0 : camera.time_offset;
}

bool haveSameTimes(const geometry::Rig& before, const geometry::Rig& now) {
  return std::all_of(now.cameras.begin(), now.cameras.end(), [&](const auto& camera) {
    return std::all_of(before.cameras.begin(), before.cameras.end(), [&](const auto& other) {
      return other.camera.name != camera.camera.name ||
             std::abs(offsetOf(other) - offsetOf(camera)) < kOffsetJump;
    });
  });
}

void lose(BodyEstimate* body) {
  body->lost = true;
  for (LedEstimate& led : body->leds)
    led.cameras.clear();
}

}  // namespace

void BodyFollower::setRig(const geometry::Rig& rig) {
  rig.check();
  const bool keeps_times = tracker_ && haveSameTimes(rig_, rig);
  if (keeps_times)
    tracker_->setRig(rig);
  else
    tracker_.emplace(rig, constellations_, options_);
  if (!keeps_times || !haveSameCameras(rig_, rig))
    arrival_clocks_.emplace(rig.cameras.size(), arrival_clocks_
                                                    ? arrival_clocks_->newestUsed()
                                                    : -std::numeric_limits<double>::infinity());
  rig_ = rig;
}

BodySnapshot BodyFollower::setBodies(const std::vector<Constellation>& constellations) {
  for (const Constellation& constellation : constellations)
    constellation.check();
  BodySnapshot lost = snapshot_;
  std::vector<std::optional<BodyEstimate>> last(constellations.size());
  for (std::size_t b = 0; b < snapshot_.bodies.size(); ++b) {
    std::optional<BodyEstimate>& body = lost.bodies[b];
    const auto same = std::find(constellations.begin(), constellations.end(), constellations_[b]);
    if (same != constellations.end())
      last[same - constellations.begin()] = std::exchange(body, {});
    else if (body && body->lost)
      body.reset();
    else if (body)
      lose(&*body);
  }
  if (constellations == constellations_)
    return lost;
  if (tracker_)
    tracker_->setBodies(constellations);
  constellations_ = constellations;
  snapshot_.bodies = std::move(last);
  return lost;
}

void BodyFollower::take(std::size_t camera,
                        const tracking::ClockError& clock,
                        tracking::CameraImage* image,
                        bool is_doubtful) {
  image->bodies = {};
  if (constellations_.empty())
    return;
  const geometry::RigCamera& calibration = rig_.cameras[camera];
  const tracking::ImageTimes times = tracking::timesOf(calibration, *image);
  switch (arrival_clocks_->check(camera, times)) {
    case tracking::ArrivalClocks::Result::kWrongClock:
      return;
    case tracking::ArrivalClocks::Result::kJumpedBack:
      tracker_->reset();
      latest_arrival_ = image->arrival;
      last_output_ = -std::numeric_limits<double>::infinity();
      break;
    case tracking::ArrivalClocks::Result::kUsable:
      break;
  }
  const auto isMasked = [&](const tracking::Spot& spot) {
    return geometry::isMasked(calibration.masks, spot.pixel);
  };
  pixels_.clear();
  for (const tracking::Spot& spot : image->spots) {
    if (!isMasked(spot))
      pixels_.push_back(spot.pixel);
  }
  const double stamp_stddev =
      std::isnan(image->stamp_stddev) ? options_.stamp_stddev : image->stamp_stddev;
  if (!tracker_->add(camera, times.exposure - clock.offset,
                     std::hypot(stamp_stddev, std::sqrt(clock.variance)), pixels_, is_doubtful))
    return;
  latest_arrival_ = std::max(latest_arrival_, image->arrival);
  image->bodies = tracker_->fit();
  auto taken = tracker_->taken().begin();  // of each spot that is not masked
  std::size_t kept = 0;
  for (const tracking::Spot& spot : image->spots) {
    if (isMasked(spot) || !*taken++)
      image->spots[kept++] = spot;
  }
  // Spots of bodies use up places in the camera's list of spots.
  image->maximum_spots -= std::min(image->spots.size() - kept, image->maximum_spots);
  image->spots.resize(kept);
}

void BodyFollower::addInertial(std::size_t body, const InertialSample& sample) {
  if (tracker_)
    tracker_->addInertial(body, sample);
}

void BodyFollower::startFromLabels(const std::vector<LabelledPoint>& points) {
  if (tracker_)
    tracker_->startFromLabels(points);
}

const BodySnapshot* BodyFollower::next() {
  if (!tracker_ || !(tracker_->time() > last_output_))
    return nullptr;
  last_output_ = tracker_->time();
  const auto& bodies = tracker_->bodies();
  snapshot_.time = last_output_;
  snapshot_.latest_arrival = latest_arrival_;
  snapshot_.bodies.resize(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::optional<BodyEstimate>& body = snapshot_.bodies[b];
    if (bodies[b] || !body || body->lost) {
      body = bodies[b];
      continue;
    }
    lose(&*body);
  }
  return &snapshot_;
}

}  // namespace wiimote_tracker::body
