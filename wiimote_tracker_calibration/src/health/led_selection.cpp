#include "health/led_selection.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::health {

namespace {

// Several LEDs are assumed when one camera gives so many successive images with several spots, and
// until none has done so for this long. False detections seldom follow each other.
constexpr int kSeveralInARow = 10;
constexpr double kSeveral = 5.0;  // [s]
// After this time another LED may be followed although fewer cameras show it, so that all cameras
// are judged in the end [s].
constexpr double kLongestFollowed = 20.0;
// Another LED is followed when more cameras have shown it for this time, as when the present one
// rests or is hidden [s].
constexpr double kHesitation = 0.6;
constexpr double kLeastSpeed = 0.1;  // Of an LED that moves [m/s].
constexpr double kRecently = 0.1;    // A camera shows an LED if it did so within this time [s].
// Two LEDs that are nearer to each other may be one spot, as in tracking/tracker_options.h [px].
constexpr double kMerged = 24.0;
// A spot is ambiguous if another one is nearer to the predicted pixel than twice its own distance
// plus this [px].
constexpr double kClearance = 6.0;
// LEDs are extrapolated from one of the tracker's images by at most this [s].
constexpr double kLongestWay = 0.05;
// Images are late by at most this, as in the tracker's history [s].
constexpr double kLatest = 0.2;

/// The spot of an LED, unless it may be that of another one, or of both.
std::optional<Eigen::Vector2d> clearSpot(const TurnedCamera& camera,
                                         const std::vector<Eigen::Vector3d>& places,
                                         std::size_t led,
                                         const LedMatches& matches,
                                         const capture::Blobs& spots) {
  const auto predicted = camera.project(places[led]);
  if (!predicted || !matches.spot_of[led] || matches.isContradictory())
    return std::nullopt;
  const Eigen::Vector2d& spot = spots[*matches.spot_of[led]];
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto other = camera.project(places[i]);
    if (i != led && !matches.spot_of[i] && other && (*other - *predicted).norm() < kMerged)
      return std::nullopt;
  }
  const double clear = 2.0 * (spot - *predicted).norm() + kClearance;
  const bool is_clear = std::count_if(spots.begin(), spots.end(), [&](const auto& other) {
                          return (other - *predicted).norm() < clear;
                        }) == 1;
  return is_clear ? std::make_optional(spot) : std::nullopt;
}

}  // namespace

LedSelection::LedSelection(const geometry::Rig& rig) : rig_(rig), tracked_rig_(rig) {
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.push_back({TurnedCamera(rig_, camera)});
}

bool LedSelection::suits(const geometry::Rig& rig) const {
  return rig_.ray_model == rig.ray_model &&
         std::equal(rig_.cameras.begin(), rig_.cameras.end(), rig.cameras.begin(),
                    rig.cameras.end(), geometry::isSameCamera);
}

const capture::Image& LedSelection::select(const capture::Image& image) {
  const geometry::RigCamera* const found = rig_.find(image.camera);
  if (found == nullptr || !std::isfinite(image.stamp) ||
      rig_.ray_model != geometry::RayModel::kCalibrated)
    return image;
  const auto index = static_cast<std::size_t>(found - rig_.cameras.data());
  const bool are_several = noteSeveral(image, &cameras_[index]);
  const auto time_offset = found->timeOffsetIn(image.clock_epoch);
  double time = image.stamp + time_offset.value_or(0.0);
  if (are_several != (tracker_ != nullptr))
    startAnew(are_several, time);
  if (!are_several && !isSilent(time))
    return image;
  selected_ = image;
  selected_.spots.clear();
  if (!are_several)
    return selected_;
  time -= tracker_->clockError(index, image.clock_epoch).offset;
  Camera& camera = cameras_[index];
  const std::vector<Led> leds = ledsAt(time);
  std::vector<Eigen::Vector3d> places;
  for (const Led& led : leds)
    places.push_back(led.position);
  const LedMatches matches = camera.turned.add(time, places, image.spots);
  for (std::size_t i = 0; i < leds.size(); ++i) {
    const auto spot = clearSpot(camera.turned, places, i, matches, image.spots);
    if (!spot)
      continue;
    camera.shown[leds[i].id] = time;
    if (leds[i].id == followedAt(time))
      selected_.spots.push_back(*spot);
  }
  if (!moments_.empty() && time > moments_.back().time - kLongestWay)
    follow(leds, time);
  useTurnOf(index, time);
  // The tracker gets no image of another device, nor of a camera that was just turned, since it
  // would move the tracks. A camera with an unknown clock is not left out: the tracker estimates
  // its clock.
  if (!found->camera.isOtherDevice(image.identity) && (!time_offset || !matches.isAstray()))
    track(index, image);
  return selected_;
}

bool LedSelection::noteSeveral(const capture::Image& image, Camera* camera) {
  camera->several_in_a_row = image.spots.size() > 1 ? camera->several_in_a_row + 1 : 0;
  if (camera->several_in_a_row >= kSeveralInARow)
    last_several_ = image.stamp;
  return std::abs(image.stamp - last_several_) < kSeveral;
}

/// Gives the tracker the camera's estimated orientation. If fewer than two cameras are where they
/// were calibrated, the tracks are wrong, and all begins anew.
void LedSelection::useTurnOf(std::size_t camera, double time) {
  geometry::Camera& tracked = tracked_rig_.cameras[camera].camera;
  const Eigen::Matrix3d now = cameras_[camera].turned.orientation();
  if (tracked.world_from_camera.linear() == now)
    return;
  tracked.world_from_camera.linear() = now;
  const auto standing = std::count_if(cameras_.begin(), cameras_.end(),
                                      [](const Camera& each) { return !each.turned.isTurned(); });
  if (standing < 2)
    forget(time);
  else
    tracker_->setRig(tracked_rig_);
}

void LedSelection::forget(double time) {
  tracked_rig_ = rig_;
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    cameras_[i].turned = TurnedCamera(rig_, rig_.cameras[i]);
  startAnew(true, time);
}

/// Replaces the tracker, or removes it. No spots are shown for kLongestGap, so that nobody
/// interpolates between two LEDs. A new tracker counts its ids from the beginning.
void LedSelection::startAnew(bool are_several, double time) {
  tracker_.reset();
  if (are_several)
    tracker_ = std::make_unique<tracking::Tracker>(tracked_rig_, tracking::TrackerOptions());
  moments_.clear();
  followed_.reset();
  followed_before_.reset();
  for (Camera& camera : cameras_)
    camera.shown.clear();
  silence_ = time + capture::kLongestGap;
}

void LedSelection::track(std::size_t camera, const capture::Image& image) {
  tracking::CameraImage seen;
  seen.stamp = seen.arrival = image.stamp;
  seen.clock_epoch = image.clock_epoch;
  for (const Eigen::Vector2d& spot : image.spots)
    seen.spots.push_back({spot, -1});
  tracker_->add(camera, seen);
  const tracking::Snapshot* const snapshot = tracker_->next();
  if (snapshot == nullptr)
    return;
  if (!moments_.empty() && snapshot->time < moments_.back().time)
    moments_.clear();  // Time jumped back.
  moments_.push_back({snapshot->time, {}});
  while (moments_.front().time < snapshot->time - kLatest)
    moments_.pop_front();
  for (const tracking::TrackedLed& led : snapshot->leds) {
    if (led.state == tracking::TrackState::kTracked && led.velocity)
      moments_.back().leds.push_back({led.id, led.position, *led.velocity});
    if (led.state != tracking::TrackState::kLost)
      continue;
    for (Camera& each : cameras_)
      each.shown.erase(led.id);
  }
}

/// The tracked LEDs where they were at a time.
std::vector<LedSelection::Led> LedSelection::ledsAt(double time) const {
  const auto nearest =
      std::min_element(moments_.begin(), moments_.end(), [&](const Moment& a, const Moment& b) {
        return std::abs(time - a.time) < std::abs(time - b.time);
      });
  if (nearest == moments_.end() || std::abs(time - nearest->time) > kLongestWay)
    return {};
  std::vector<Led> leds = nearest->leds;
  for (Led& led : leds)
    led.position += (time - nearest->time) * led.velocity;
  return leds;
}

/// How many cameras show an LED unambiguously; 0 while it rests.
std::size_t LedSelection::worthOf(const Led& led, double time) const {
  if (led.velocity.norm() < kLeastSpeed)
    return 0;
  return static_cast<std::size_t>(
      std::count_if(cameras_.begin(), cameras_.end(), [&](const Camera& camera) {
        const auto shown = camera.shown.find(led.id);
        return shown != camera.shown.end() && std::abs(time - shown->second) < kRecently;
      }));
}

/// Changes to the LED that most cameras show, if the present one has not been that one for
/// kHesitation, or was followed for kLongestFollowed.
void LedSelection::follow(const std::vector<Led>& leds, double time) {
  std::size_t worth = 0;  // Cameras that show the one that is followed.
  const Led* best = nullptr;
  std::size_t most = 0;
  for (const Led& led : leds) {
    if (led.id == followed_) {
      worth = worthOf(led, time);
    } else if (worthOf(led, time) > most) {
      best = &led;
      most = worthOf(led, time);
    }
  }
  if (worth >= most)
    last_best_ = time;
  const bool had_its_turn = std::abs(time - followed_since_) > kLongestFollowed && 2 * most > worth;
  if (best == nullptr || (followed_ && std::abs(time - last_best_) < kHesitation && !had_its_turn))
    return;
  // As in startAnew().
  if (followed_)
    silence_ = time + capture::kLongestGap;
  followed_before_ = std::exchange(followed_, best->id);
  followed_since_ = last_best_ = time;
}

/// An image that comes late shows the LED that was followed then.
std::optional<std::uint32_t> LedSelection::followedAt(double time) const {
  if (isSilent(time))
    return std::nullopt;
  return time < followed_since_ ? followed_before_ : followed_;
}

}  // namespace wiimote_tracker::health
