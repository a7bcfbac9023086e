#include "body/body_tracker.h"

#include "wiimote_tracker_triangulation/geometry/shared_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::body {
namespace {

/// Images that may be computed again per new image, because samples of an IMU came later.
constexpr std::size_t kRepeats = 16;

void lose(BodyEstimate* body) {
  body->lost = true;
  for (LedEstimate& led : body->leds)
    led.cameras.clear();
}

}  // namespace

BodyTracker::BodyTracker(const BodyTrackerOptions& options)
    : setup_{options, {}, {}, {}, {}},
      intake_(options.stamp_stddev),
      history_(&state_, options.history),
      update_(setup_, &state_) {}

BodyTracker::BodyTracker(const geometry::Rig& rig,
                         const std::vector<Constellation>& constellations,
                         const BodyTrackerOptions& options)
    : BodyTracker(options) {
  setRig(rig);
  setBodies(constellations);
}

void BodyTracker::useRig(const geometry::Rig& rig) {
  setup_.rig = rig;
  setup_.cameras = rig.rayCameras();
  setup_.partners = geometry::sharedViews(rig, setup_.options.maximum_range);
  search_.emplace(setup_, &state_, &update_);
  state_.images.assign(rig.cameras.size(), {});
}

void BodyTracker::setRig(const geometry::Rig& rig) {
  rig.check();
  if (!intake_.setRig(rig))
    reset();
  auto images = history_.images();
  history_.rollBack(images.begin());
  history_.clear();
  const std::vector<geometry::RigCamera> before = setup_.rig.cameras;
  useRig(rig);
  for (std::uint64_t i = images.begin(); i < images.end(); ++i) {
    const auto same = std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const auto& camera) {
      return camera.camera.name == before[images.at(i).camera].camera.name;
    });
    if (same == rig.cameras.end())
      continue;
    images.at(i).camera = same - rig.cameras.begin();
    history_.add(images.at(i));
  }
  history_.catchUp([this](const BodyImage& image) { step(image); });
  for (std::optional<KnownBody>& body : state_.bodies) {
    if (body && time_ - body->last_observed > setup_.options.tracked_time)
      body.reset();
  }
  estimate();
}

BodySnapshot BodyTracker::setBodies(const std::vector<Constellation>& constellations) {
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
  if (constellations != constellations_)
    replaceBodies(constellations);
  snapshot_.bodies = std::move(last);
  return lost;
}

void BodyTracker::replaceBodies(const std::vector<Constellation>& constellations) {
  constellations_ = constellations;
  const auto before = std::exchange(setup_.bodies, {});
  std::vector<std::size_t> former;  // index of each body, or the number of bodies if it is new
  for (const Constellation& constellation : constellations) {
    const auto same = std::find_if(before.begin(), before.end(), [&](const BodyModel& body) {
      return body.constellation == constellation;
    });
    former.push_back(same - before.begin());
    setup_.bodies.push_back(same != before.end() ? *same : BodyModel(constellation));
  }
  const auto carryOver = [&](BodyState* state) {
    const auto bodies = std::exchange(state->bodies, {});
    for (const std::size_t body : former)
      state->bodies.push_back(body < bodies.size() ? bodies[body] : std::nullopt);
    state->images.assign(setup_.cameras.size(), {});  // their spots name bodies by index
  };
  carryOver(&state_);
  history_.changeStates(carryOver);
  auto& images = history_.images();
  for (std::uint64_t i = images.begin(); i < images.end(); ++i) {
    for (const BodyImage::LabelStart& start : std::exchange(images.at(i).starts, {})) {
      const auto now = std::find(former.begin(), former.end(), start.body);
      if (now != former.end())
        images.at(i).starts.push_back({static_cast<std::size_t>(now - former.begin()), start.pose});
    }
  }
  estimates_.assign(setup_.bodies.size(), std::nullopt);
  estimate();
}

void BodyTracker::reset() {
  state_.bodies.assign(setup_.bodies.size(), std::nullopt);
  state_.images.assign(setup_.cameras.size(), {});
  history_.clear();
  for (BodyModel& body : setup_.bodies)
    body.inertial.clear();
  inertial_change_ = std::numeric_limits<double>::infinity();
  time_ = -std::numeric_limits<double>::infinity();
  estimates_.assign(setup_.bodies.size(), std::nullopt);
}

void BodyTracker::take(std::size_t camera,
                       const tracking::ClockError& clock,
                       tracking::CameraImage* image,
                       bool is_doubtful) {
  using Result = tracking::ImageIntake::Result;
  image->bodies = {};
  if (constellations_.empty())
    return;
  const Result result = intake_.take(camera, *image, clock, &image_);
  if (result == Result::kWrongClock)
    return;
  if (result == Result::kJumpedBack) {
    reset();
    latest_arrival_ = image->arrival;
    last_output_ = -std::numeric_limits<double>::infinity();
  }
  image_.is_doubtful = is_doubtful;
  image_.pixels.clear();
  const auto isMasked = [&](const tracking::Spot& spot) {
    return geometry::isMasked(setup_.rig.cameras[camera].masks, spot.pixel);
  };
  for (const tracking::Spot& spot : image->spots) {
    if (!isMasked(spot))
      image_.pixels.push_back(spot.pixel);
  }
  const tracking::Outcome outcome = history_.add(image_);
  if (outcome == tracking::Outcome::kDropped || outcome == tracking::Outcome::kRepeated)
    return;
  const std::uint64_t place = *history_.placeOf(image_);
  history_.rollBack(firstOutdated(place));
  history_.catchUp([&](const BodyImage& stored) {
    step(stored);
    if (&stored == &history_.images().at(place)) {
      taken_ = update_.taken();
      image->bodies = update_.fit();
    }
  });
  time_ = std::max(time_, image_.time);
  estimate();
  latest_arrival_ = std::max(latest_arrival_, image->arrival);
  auto taken = taken_.begin();  // of each spot that is not masked
  std::size_t kept = 0;
  for (const tracking::Spot& spot : image->spots) {
    if (isMasked(spot) || !*taken++)
      image->spots[kept++] = spot;
  }
  // Spots of bodies use up places in the camera's list of spots.
  image->maximum_spots -= std::min(image->spots.size() - kept, image->maximum_spots);
  image->spots.resize(kept);
}

const BodySnapshot* BodyTracker::next() {
  if (!(time_ > last_output_))
    return nullptr;
  last_output_ = time_;
  snapshot_.time = time_;
  snapshot_.latest_arrival = latest_arrival_;
  snapshot_.bodies.resize(estimates_.size());
  for (std::size_t b = 0; b < estimates_.size(); ++b) {
    std::optional<BodyEstimate>& body = snapshot_.bodies[b];
    if (estimates_[b] || !body || body->lost)
      body = estimates_[b];
    else
      lose(&*body);
  }
  return &snapshot_;
}

/// The first image before `place` for which a sample of an IMU came too late, or `place`. If they
/// are many, waits for more new images.
std::uint64_t BodyTracker::firstOutdated(std::uint64_t place) {
  const auto& images = history_.images();
  std::uint64_t first = place;
  while (first > images.begin() && images.at(first - 1).time > inertial_change_)
    --first;
  ++images_since_repeat_;
  if (place - first > kRepeats * images_since_repeat_)
    return place;
  images_since_repeat_ = 0;
  inertial_change_ = std::numeric_limits<double>::infinity();
  return first;
}

void BodyTracker::addInertial(std::size_t body, const InertialSample& sample) {
  inertial_change_ = std::min(inertial_change_, setup_.bodies[body].inertial.add(sample));
}

void BodyTracker::step(const BodyImage& image) {
  update_.follow(image);
  dropLost(image.time);
  search_->find(image);
  for (const BodyImage::LabelStart& start : image.starts) {
    if (!state_.bodies[start.body])
      state_.bodies[start.body].emplace(setup_.options, image.time, start.pose, 0);
  }
}

void BodyTracker::dropLost(double time) {
  for (std::optional<KnownBody>& body : state_.bodies) {
    if (body && (time - body->last_observed > setup_.options.prediction_time ||
                 !body->filter.state().poseCovariance().allFinite()))
      body.reset();
  }
}

void BodyTracker::startFromLabels(const std::vector<LabelledPoint>& points) {
  auto& images = history_.images();
  if (images.empty())
    return;
  BodyImage& newest = images.at(images.end() - 1);
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    const Constellation& constellation = setup_.bodies[b].constellation;
    if (state_.bodies[b] || constellation.labels.empty())
      continue;
    if (const auto pose = poseFromLabels(constellation, points)) {
      state_.bodies[b].emplace(setup_.options, newest.time, *pose, 0);
      newest.starts.push_back({b, *pose});  // for when a late image undoes this one
      estimateBody(b, time_, setup_, state_, &estimates_[b]);
    }
  }
}

void BodyTracker::estimate() {
  for (std::size_t b = 0; b < estimates_.size(); ++b)
    estimateBody(b, time_, setup_, state_, &estimates_[b]);
}

}  // namespace wiimote_tracker::body
