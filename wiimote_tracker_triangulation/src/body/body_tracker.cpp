#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include "association/assign_spots.h"
#include "association/shared_views.h"
#include "led_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::body {
namespace {

/// Images that may be computed again per new image, because samples of an IMU came later.
constexpr std::size_t kRepeats = 16;

/// Cost of a false detection: greater than that of any LED.
constexpr double kGhostCost = 1e6;

}  // namespace

BodyTracker::BodyTracker(const geometry::Rig& rig,
                         const std::vector<Constellation>& constellations,
                         const BodyTrackerOptions& options)
    : options_(options) {
  useRig(rig);
  setBodies(constellations);
}

void BodyTracker::useRig(const geometry::Rig& rig) {
  rig.check();
  rig_ = rig;
  associator_.emplace(rig, association::sharedViews(rig, options_.maximum_range), searchOptions());
  cameras_ = rig_.rayCameras();
  candidates_.resize(cameras_.size());
  sights_.resize(cameras_.size());
  views_.resize(cameras_.size());
  state_.images.assign(cameras_.size(), {});
}

void BodyTracker::setRig(const geometry::Rig& rig) {
  rig.check();
  auto images = history_.images();
  if (!images.empty())
    history_.rollBack(images.begin(), &state_);
  history_.clear();
  const std::vector<geometry::RigCamera> before = rig_.cameras;
  useRig(rig);
  for (std::uint64_t i = images.begin(); i < images.end(); ++i) {
    Image& image = images.at(i);
    const auto same = std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const auto& camera) {
      return camera.camera.name == before[image.camera].camera.name;
    });
    if (same == rig.cameras.end())
      continue;
    image.camera = same - rig.cameras.begin();
    history_.insert(history_.images().end(), image);
    step(history_.images().end() - 1);
  }
  for (std::optional<Body>& body : state_.bodies) {
    if (body && time_ - body->last_observed > options_.tracked_time)
      body.reset();
  }
  estimate();
}

void BodyTracker::setBodies(const std::vector<Constellation>& constellations) {
  for (const Constellation& constellation : constellations)
    constellation.check();
  const auto before = std::exchange(constellations_, constellations);
  const auto inertial_before = std::exchange(inertial_, {});
  std::vector<std::size_t> former;  // index of each body, or the number of bodies if it is new
  has_clear_shape_.clear();
  for (const Constellation& constellation : constellations_) {
    const auto same = std::find(before.begin(), before.end(), constellation);
    former.push_back(same - before.begin());
    has_clear_shape_.push_back(nearestSymmetry(constellation).residual >= kSymmetric);
    const ImuMount imu = constellation.imu.value_or(ImuMount());
    inertial_.push_back(same != before.end() ? inertial_before[former.back()]
                                             : InertialSamples(imu.body_from_imu.translation()));
  }
  const auto carryOver = [&](State* state) {
    const auto bodies = std::exchange(state->bodies, {});
    for (const std::size_t body : former)
      state->bodies.push_back(body < bodies.size() ? bodies[body] : std::nullopt);
    state->images.assign(cameras_.size(), {});  // their spots name bodies by index
  };
  carryOver(&state_);
  history_.changeStates(carryOver);
  auto& images = history_.images();
  for (std::uint64_t i = images.begin(); i < images.end(); ++i) {
    for (const LabelStart& start : std::exchange(images.at(i).starts, {})) {
      const auto now = std::find(former.begin(), former.end(), start.body);
      if (now != former.end())
        images.at(i).starts.push_back({static_cast<std::size_t>(now - former.begin()), start.pose});
    }
  }
  estimates_.assign(constellations_.size(), std::nullopt);
  estimate();
}

void BodyTracker::reset() {
  state_.bodies.assign(constellations_.size(), std::nullopt);
  state_.images.assign(cameras_.size(), {});
  history_.clear();
  for (InertialSamples& samples : inertial_)
    samples.clear();
  inertial_change_ = std::numeric_limits<double>::infinity();
  time_ = -std::numeric_limits<double>::infinity();
  estimates_.assign(constellations_.size(), std::nullopt);
}

bool BodyTracker::add(std::size_t camera,
                      double time,
                      double stamp_stddev,
                      const std::vector<Eigen::Vector2d>& pixels) {
  taken_.assign(pixels.size(), false);
  image_.camera = camera;
  image_.time = time;
  image_.stamp_stddev = stamp_stddev;
  image_.pixels = pixels;
  const auto place = history_.placeOf(image_);
  if (!place || time < time_ - options_.history)
    return false;
  const auto& images = std::as_const(history_).images();
  std::uint64_t next = firstOutdated(*place);
  if (next < images.end())
    next = history_.rollBack(next, &state_);
  history_.insert(*place, image_);
  for (; next < images.end(); ++next) {
    step(next);
    if (next == *place)
      std::swap(taken_, spots_taken_);
  }
  time_ = std::max(time_, time);
  history_.forgetBefore(time_ - options_.history);
  estimate();
  return true;
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
  inertial_change_ = std::min(inertial_change_, inertial_[body].add(sample));
}

void BodyTracker::step(std::uint64_t place) {
  history_.keep(place, state_);
  const Image& image = history_.images().at(place);
  follow(image);
  dropLost(image.time);
  find(image);
  for (const LabelStart& start : image.starts) {
    if (!state_.bodies[start.body])
      startAt(start.body, start.pose, image.time, 0);
  }
}

/// All spots of a body in an image share the error of its time: as if each had its own one, which
/// is greater. @param spots of the body
SpotNoise BodyTracker::noiseOf(const Image& image, double spots) const {
  return {geometry::pixelNoise(rig_.cameras[image.camera], options_.learnt_noise,
                               options_.pixel_stddev),
          image.stamp_stddev * std::sqrt(spots)};
}

LedGroups BodyTracker::groupsOf(std::size_t body, const Image& image, double spots) const {
  return {state_.bodies[body]->filter.state(),
          constellations_[body],
          cameras_[image.camera],
          noiseOf(image, spots),
          options_.merging_distance,
          options_.gate};
}

/// Assigns spots of an image to LEDs of the bodies, which are predicted to its time: led_of_spot_.
void BodyTracker::assign(const Image& image) {
  const std::vector<Eigen::Vector2d>& pixels = image.pixels;
  association::SpotCosts costs;
  std::array<SpotLed, association::kMaximumTracks> columns;
  const std::size_t spots = std::min(pixels.size(), association::kMaximumSpots);
  // Which LEDs the body itself hides is unknown: a missed LED costs nothing, so that as many spots
  // as possible are assigned.
  costs.reset(spots, association::kMaximumTracks, kGhostCost, 0.0);
  costs.tracks = 0;
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (!state_.bodies[b])
      continue;
    const LedGroups groups = groupsOf(b, image, 1.0);
    for (std::size_t led = 0; led < constellations_[b].leds.size(); ++led) {
      if (costs.tracks == association::kMaximumTracks)
        break;
      for (std::size_t s = 0; s < spots; ++s)
        costs.pair[s][costs.tracks] = groups.cost(led, pixels[s]);
      columns[costs.tracks++] = {b, led};
    }
  }
  const auto track_of_spot = association::assignSpots(costs);
  led_of_spot_.assign(pixels.size(), std::nullopt);
  for (std::size_t s = 0; s < spots; ++s) {
    if (track_of_spot[s] != association::kFalseDetection)
      led_of_spot_[s] = columns[track_of_spot[s]];
  }
}

/// Which LEDs of a body have a spot in the image that assign() was called with.
std::array<bool, kMaximumLeds> BodyTracker::ledsWithSpot(std::size_t body) const {
  std::array<bool, kMaximumLeds> has_spot{};
  for (const std::optional<SpotLed>& spot : led_of_spot_) {
    if (spot && spot->body == body)
      has_spot[spot->led] = true;
  }
  return has_spot;
}

/// Whether a spot of the same body, other than this one, fits only as that of several LEDs.
bool BodyTracker::hasMerged(const LedGroups& groups,
                            const Image& image,
                            std::size_t spot,
                            const std::array<bool, kMaximumLeds>& has_spot) const {
  std::array<bool, kMaximumLeds> all_have_spots;
  all_have_spots.fill(true);
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    const std::optional<SpotLed>& other = led_of_spot_[s];
    if (s != spot && other && other->body == led_of_spot_[spot]->body &&
        !groups.best(other->led, image.pixels[s], all_have_spots) &&
        groups.best(other->led, image.pixels[s], has_spot))
      return true;
  }
  return false;
}

void BodyTracker::follow(const Image& image) {
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (state_.bodies[b])
      state_.bodies[b]->filter.predict(image.time, inertial_[b]);
  }
  assign(image);
  leaveToSearch(image.time);
  LastImage& last = state_.images[image.camera];
  last.time = image.time;
  last.taken.clear();
  last.free.clear();
  spots_taken_.assign(image.pixels.size(), false);
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    spots_taken_[s] = led_of_spot_[s] && take(s, image, &last);
    if (!spots_taken_[s])
      last.free.push_back(image.pixels[s]);
  }
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (state_.bodies[b] && isSeen(b, last))
      state_.bodies[b]->last_observed = image.time;
  }
}

/// Updates the body of an assigned spot with it. False if the spot does not fit any more, since
/// each update moves the body: it is of another light, or the pose is wrong, and the search needs
/// it.
bool BodyTracker::take(std::size_t spot, const Image& image, LastImage* last) {
  const auto [body, led] = *led_of_spot_[spot];
  const Eigen::Vector2d& pixel = image.pixels[spot];
  const std::array<bool, kMaximumLeds> has_spot = ledsWithSpot(body);
  const auto spots = static_cast<double>(std::count(has_spot.begin(), has_spot.end(), true));
  const LedGroups groups = groupsOf(body, image, spots);
  const LedGroup* group = groups.best(led, pixel, has_spot);
  if (!group)
    return hasMerged(groups, image, spot, has_spot);
  update(body, *group, pixel, cameras_[image.camera], last);
  return true;
}

void BodyTracker::update(std::size_t index,
                         const LedGroup& group,
                         const Eigen::Vector2d& pixel,
                         const geometry::Camera& camera,
                         LastImage* image) {
  Body& body = *state_.bodies[index];
  const double residual = (pixel - group.prediction.pixel).norm();
  const double misfit = group.misfit(pixel);
  body.filter.update(group.prediction, pixel, inertial_[index]);
  for (std::size_t i = 0; i < group.leds.size(); ++i) {
    body.led_times[group.leds[i]] = image->time;
    image->taken.push_back({index, group.leds[i], i > 0, pixel, misfit, residual,
                            residual * group.prediction.depth / camera.intrinsics.fx});
  }
}

void BodyTracker::dropLost(double time) {
  for (std::optional<Body>& body : state_.bodies) {
    if (body && (time - body->last_observed > options_.prediction_time ||
                 !body->filter.state().poseCovariance().allFinite()))
      body.reset();
  }
}

}  // namespace wiimote_tracker::body
