#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include "association/assign_spots.h"
#include "association/shared_views.h"
#include "led_groups.h"

#include <algorithm>
#include <cmath>

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
    : constellations_(constellations), options_(options) {
  useRig(rig);
  for (const Constellation& constellation : constellations) {
    constellation.check();
    has_clear_shape_.push_back(nearestSymmetry(constellation).residual >= kSymmetric);
    const ImuMount imu = constellation.imu.value_or(ImuMount());
    inertial_.emplace_back(Eigen::Vector3d(imu.body_from_imu.translation()));
  }
  reset();
}

void BodyTracker::useRig(const geometry::Rig& rig) {
  rig.check();
  rig_ = rig;
  associator_.emplace(rig, association::sharedViews(rig, options_.maximum_range), searchOptions());
  cameras_.clear();
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.push_back(rig_.rayCamera(camera));
  candidates_.resize(cameras_.size());
  sights_.resize(cameras_.size());
  views_.resize(cameras_.size());
  images_.assign(cameras_.size(), {});
}

void BodyTracker::setRig(const geometry::Rig& rig) {
  rig.check();
  for (auto entry = history_.end(); entry != history_.begin();)
    undo(--entry);
  const std::vector<geometry::RigCamera> before = rig_.cameras;
  useRig(rig);
  for (auto entry = history_.begin(); entry != history_.end();) {
    const auto next = std::next(entry);
    const auto same = std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const auto& camera) {
      return camera.camera.name == before[entry->camera].camera.name;
    });
    if (same == rig.cameras.end()) {
      spare_.splice(spare_.end(), history_, entry);
    } else {
      entry->camera = static_cast<std::size_t>(same - rig.cameras.begin());
      take(entry);
    }
    entry = next;
  }
  for (std::optional<Body>& body : bodies_) {
    if (body && time_ - body->last_observed > options_.tracked_time)
      body.reset();
  }
  estimate();
}

void BodyTracker::reset() {
  bodies_.assign(constellations_.size(), std::nullopt);
  images_.assign(cameras_.size(), {});
  history_.clear();
  for (InertialSamples& samples : inertial_)
    samples.clear();
  inertial_change_ = std::numeric_limits<double>::infinity();
  time_ = -std::numeric_limits<double>::infinity();
  estimates_.assign(constellations_.size(), std::nullopt);
}

bool BodyTracker::add(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels) {
  taken_.assign(pixels.size(), false);
  if (time < time_ - options_.history)
    return false;
  // Undo the images that are later than this one; they are processed again below.
  auto next = history_.end();
  const auto comesAfter = [&](const Entry& entry) {
    return entry.time != time ? entry.time > time : entry.camera > camera;
  };
  while (next != history_.begin() && comesAfter(*std::prev(next)))
    undo(--next);
  const auto first = undoOutdated(next);
  if (spare_.empty())
    spare_.emplace_back();
  history_.splice(next, spare_, spare_.begin());
  const auto entry = std::prev(next);
  entry->camera = camera;
  entry->time = time;
  entry->pixels = pixels;
  for (auto each = first == next ? entry : first; each != history_.end(); ++each) {
    take(each);
    if (each == entry)
      std::swap(taken_, spots_taken_);
  }
  time_ = std::max(time_, time);
  while (history_.front().time < time_ - options_.history)
    spare_.splice(spare_.end(), history_, history_.begin());
  estimate();
  return true;
}

/// Undoes the images before `next` for which a sample of an IMU came too late. If they are many,
/// waits for more new images. @returns the first image to process (again)
std::list<BodyTracker::Entry>::iterator BodyTracker::undoOutdated(std::list<Entry>::iterator next) {
  auto first = next;
  std::size_t count = 0;
  for (; first != history_.begin() && std::prev(first)->time > inertial_change_; ++count)
    --first;
  ++images_since_repeat_;
  if (count > kRepeats * images_since_repeat_)
    return next;
  while (next != first)
    undo(--next);
  images_since_repeat_ = 0;
  inertial_change_ = std::numeric_limits<double>::infinity();
  return first;
}

void BodyTracker::addInertial(std::size_t body, const InertialSample& sample) {
  inertial_change_ = std::min(inertial_change_, inertial_[body].add(sample));
}

void BodyTracker::undo(std::list<Entry>::iterator entry) {
  std::swap(bodies_, entry->bodies_before);
  std::swap(images_[entry->camera], entry->image_before);
}

void BodyTracker::take(std::list<Entry>::iterator entry) {
  entry->bodies_before = bodies_;
  entry->image_before = images_[entry->camera];
  follow(entry->camera, entry->time, entry->pixels);
  dropLost(entry->time);
  find(entry->camera, entry->pixels);
}

LedGroups BodyTracker::groupsOf(std::size_t body, std::size_t camera) const {
  const double noise =
      geometry::pixelNoise(rig_.cameras[camera], options_.learnt_noise, options_.pixel_stddev);
  return {bodies_[body]->filter.state(), constellations_[body], cameras_[camera], noise,
          options_.merging_distance,     options_.gate};
}

/// Assigns spots of an image to LEDs of the bodies, which are predicted to its time: led_of_spot_.
void BodyTracker::assign(std::size_t camera, const std::vector<Eigen::Vector2d>& pixels) {
  association::SpotCosts costs;
  std::array<SpotLed, association::kMaximumTracks> columns;
  const std::size_t spots = std::min(pixels.size(), association::kMaximumSpots);
  // Which LEDs the body itself hides is unknown: a missed LED costs nothing, so that as many spots
  // as possible are assigned.
  costs.reset(spots, association::kMaximumTracks, kGhostCost, 0.0);
  costs.tracks = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b])
      continue;
    const LedGroups groups = groupsOf(b, camera);
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
      led_of_spot_[s] = columns[static_cast<std::size_t>(track_of_spot[s])];
  }
}

void BodyTracker::follow(std::size_t camera,
                         double time,
                         const std::vector<Eigen::Vector2d>& pixels) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b])
      bodies_[b]->filter.predict(time, inertial_[b]);
  }
  assign(camera, pixels);
  leaveToSearch(time);
  const geometry::Camera& view = cameras_[camera];
  LastImage& image = images_[camera];
  image.time = time;
  image.taken.clear();
  image.free.clear();
  spots_taken_.assign(pixels.size(), false);
  for (std::size_t s = 0; s < pixels.size(); ++s) {
    if (!led_of_spot_[s]) {
      image.free.push_back(pixels[s]);
      continue;
    }
    spots_taken_[s] = true;
    const SpotLed spot = *led_of_spot_[s];
    std::array<bool, kMaximumLeds> has_spot{};
    for (const std::optional<SpotLed>& other : led_of_spot_) {
      if (other && other->body == spot.body)
        has_spot[other->led] = true;
    }
    // Each update moves the body, and with it the predictions of the remaining spots.
    const LedGroups groups = groupsOf(spot.body, camera);
    if (const LedGroup* group = groups.best(spot.led, pixels[s], has_spot))
      update(spot.body, *group, pixels[s], view, &image);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b] && isSeen(b, image))
      bodies_[b]->last_observed = time;
  }
}

void BodyTracker::update(std::size_t index,
                         const LedGroup& group,
                         const Eigen::Vector2d& pixel,
                         const geometry::Camera& camera,
                         LastImage* image) {
  Body& body = *bodies_[index];
  const double residual = (pixel - group.prediction.pixel).norm();
  const double misfit = group.misfit(pixel);
  body.filter.update(group.prediction, pixel, group.pixel_stddev, inertial_[index]);
  for (std::size_t i = 0; i < group.leds.size(); ++i) {
    body.led_times[group.leds[i]] = image->time;
    image->taken.push_back({index, group.leds[i], i > 0, pixel, misfit, residual,
                            residual * group.prediction.depth / camera.intrinsics.fx});
  }
}

void BodyTracker::dropLost(double time) {
  for (std::optional<Body>& body : bodies_) {
    if (body && (time - body->last_observed > options_.prediction_time ||
                 !body->filter.state().poseCovariance().allFinite()))
      body.reset();
  }
}

}  // namespace wiimote_tracker::body
