#include "track.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {
namespace {

constexpr unsigned kRecentImages = 0xf;  // mask of the last four

// Time constants [spots]. Two tracks that share nearly all of 64 spots follow one LED; two LEDs
// that pass each other share fewer. A track with many spots of its own uses the longer one.
constexpr double kShortMemory = 64.0;
constexpr double kLongMemory = 256.0;
constexpr double kLeastUnmerged = 0.15;
constexpr double kMostlyOwn = 0.7;

// Detections of a lost LED before its track goes on. Two or three false detections may form a
// point; a fourth hardly ever is near it.
constexpr std::size_t kReacquisitionSpots = 4;

}  // namespace

/// The record of a camera. Adds one if it has none, in place of the oldest if there are too many.
CameraRecord& Track::recordOf(std::size_t camera) {
  const auto record = std::find_if(records_.begin(), records_.end(),
                                   [&](auto& known) { return known.camera == camera; });
  if (record != records_.end())
    return *record;
  if (records_.size() == kMaximumCameras)
    records_.erase(std::min_element(records_.begin(), records_.end(), [](auto& a, auto& b) {
      return a.last_expected < b.last_expected;
    }));
  CameraRecord& added = records_.emplace_back();
  added.camera = camera;
  added.last_expected = added.last_saturated = added.last_detected = added.last_detected_alone =
      -std::numeric_limits<double>::infinity();
  return added;
}

Track::Track(const motion::MotionFilter& start, std::uint32_t led_id)
    : filter(start),
      id(led_id),
      initiated_(start.time()),
      started_(initiated_),
      last_observed_(initiated_),
      last_located_(initiated_),
      position_(start.position()),
      velocity_(Eigen::Vector3d::Zero()),
      position_time_(initiated_) {}

void Track::miss(std::size_t camera, double time) {
  CameraRecord& record = recordOf(camera);
  record.last_expected = time;
  record.recent = record.recent << 1 & kRecentImages;
  ++misses_in_a_row_;
}

void Track::noteSaturated(std::size_t camera, double time) {
  recordOf(camera).last_saturated = time;
}

void Track::hit(std::size_t camera,
                const Eigen::Vector2d& residual,
                const Track* other,
                bool is_own) {
  const double time = filter.time();
  CameraRecord& record = recordOf(camera);
  if (!record.recent)
    record.ray = RayOffset();
  record.last_expected = time;
  record.last_detected = time;
  if (is_own)
    record.last_detected_alone = time;
  record.squared_residual = residual.squaredNorm();
  record.recent = (record.recent << 1 | 1) & kRecentImages;
  misses_in_a_row_ = 0;
  last_observed_ = time;
  position_ = filter.position();
  velocity_ = filter.velocity();
  position_time_ = time;
  if (!other) {
    ++hits_;
    unmerged_share_ += (1.0 - unmerged_share_) / kShortMemory;
    return;
  }
  const double memory =
      std::min(std::max(0.5 * static_cast<double>(hits_), kShortMemory), kLongMemory);
  unmerged_share_ -= unmerged_share_ / memory;
  own_share_ += ((is_own ? 1.0 : 0.0) - own_share_) / kShortMemory;
  shared_with_ = other->id;
}

void Track::noteRay(std::size_t camera, const RayOffset& ray) {
  recordOf(camera).ray.add(ray);
}

bool Track::isDuplicate() const {
  return unmerged_share_ < kLeastUnmerged &&
         (own_share_ < 1.0 - kMostlyOwn || (own_share_ < kMostlyOwn && shared_with_ < id));
}

void Track::addInitialSpot(std::size_t camera, double time, double residual) {
  CameraRecord& record = recordOf(camera);
  record.last_expected = record.last_detected = record.last_detected_alone = time;
  started_ = std::min(started_, time);
  ++initial_spots_;
  record.squared_residual = residual * residual;
  record.recent = 1;
}

void Track::continueAs(const Track& found) {
  Track result = found;
  result.id = id;
  result.initiated_ = initiated_;
  result.same_led_probability_ = same_led_probability_;
  result.crowded_since_ = crowded_since_;
  result.last_crowded_ = last_crowded_;
  result.confirmed_ = true;
  result.agreement_.reacquire();
  *this = result;
}

Track::Visibility Track::visibilityAt(double time, const TrackerOptions& options) const {
  Visibility result;
  const double since = time - options.tracked_time;
  for (const CameraRecord& record : records_) {
    const bool is_expected = record.last_expected >= since;
    result.expected += is_expected;
    result.in_view += is_expected || record.last_saturated >= since;
    result.supporting += is_expected && std::bitset<4>(record.recent).count() >= 2;
    if (record.last_detected < since)
      continue;
    if (result.detected < result.rays.size())
      result.rays[result.detected] = &record.ray;
    ++result.detected;
    result.squared_residuals += record.squared_residual;
  }
  return result;
}

/// False detections can look like a crowd, but for a few images only.
void Track::noteCrowd(double time) {
  constexpr double kLongestGap = 0.05;  // [s]
  if (time - last_crowded_ > kLongestGap)
    crowded_since_ = time;
  last_crowded_ = time;
}

bool Track::isCrowded(double time) const {
  constexpr double kMemory = 0.2;  // [s]
  return time - last_crowded_ <= std::min(last_crowded_ - crowded_since_, kMemory);
}

void Track::updateStatus(double time, const TrackerOptions& options, bool in_crowd) {
  const Visibility now = visibilityAt(time, options);
  if (now.detected >= 2)
    last_located_ = time;
  weighRays(now, time, options);
  if (!position_.allFinite())
    finished_ = true;
  else if (confirmed_)
    finished_ = time - last_observed_ > options.prediction_time ||
                time - last_located_ > options.single_view_time || isDuplicate();
  else
    updateTentative(now, time, options, in_crowd);
}

void Track::weighRays(const Visibility& now, double time, const TrackerOptions& options) {
  const auto [a, b] = now.rays;
  if (now.detected > 2)
    agreement_.weigh(0.0, options.pixel_stddev, time);
  else if (now.detected == 2 && a->count > 0.0 && b->count > 0.0)
    agreement_.weigh(distanceOf(*a, *b), stddevOf(*a, *b), time);
  else
    agreement_.wait(time);
}

/// In a crowd, nobody is confirmed where only two cameras look: facing ones often show a light each
/// whose rays meet.
void Track::updateTentative(const Visibility& now,
                            double time,
                            const TrackerOptions& options,
                            bool in_crowd) {
  constexpr double kMaximumTentativeTime = 0.5;  // [s]
  const bool is_supported =
      now.supporting >= 2 && now.supporting >= options.minimum_support * now.expected;
  const bool is_doubtful = isDoubtful(now.supporting, now.in_view);
  const double limit = options.birth_pixel_stddev;
  may_continue_ = initial_spots_ + hits_ >= kReacquisitionSpots &&
                  now.squared_residuals <= now.detected * limit * limit &&
                  (now.detected >= 3 || (is_supported && agreement_.areNowOne()));
  confirmed_ = is_supported && hits_ >= options.confirmation_hits && !is_doubtful &&
               !(in_crowd && now.in_view == 2);

  const double unseen = time - last_observed_;
  const double patience = options.tracked_time + options.dark_time;
  const bool is_missed =
      unseen >= options.dark_time && misses_in_a_row_ >= 2 * std::max<std::size_t>(now.expected, 2);
  const bool is_too_old =
      time - initiated_ > kMaximumTentativeTime + options.dark_time && !is_doubtful;
  finished_ = !confirmed_ &&
              (unseen > patience || time - last_located_ > patience || is_missed || is_too_old);
}

/// Whether only two cameras see it of more that have it in view, and these two may see different
/// lights.
bool Track::isDoubtful(std::size_t seen_by, std::size_t in_view) const {
  return seen_by == 2 && in_view > 2 && !agreement_.areLikelyOne();
}

Eigen::Vector3d Track::approximatePosition(double time) const {
  return position_ + (time - position_time_) * velocity_;
}

bool Track::isShownBeside(const Track& other, double since) const {
  for (const CameraRecord& record : records_) {
    for (const CameraRecord& others : other.records_) {
      if (record.camera == others.camera &&
          record.last_detected_alone == others.last_detected_alone &&
          record.last_detected_alone >= since && std::isfinite(record.last_detected_alone))
        return true;
    }
  }
  return false;
}

double Track::lastDetectedBy(std::size_t camera) const {
  const auto record = std::find_if(records_.begin(), records_.end(),
                                   [&](auto& known) { return known.camera == camera; });
  return record == records_.end() ? -std::numeric_limits<double>::infinity()
                                  : record->last_detected;
}

bool Track::wasMissedBy(std::size_t camera) const {
  return std::any_of(records_.begin(), records_.end(), [&](const CameraRecord& record) {
    return record.camera == camera && !(record.recent & 1);
  });
}

CameraList Track::othersSeeing(std::size_t camera, double since) const {
  CameraList others;
  for (const CameraRecord& record : records_) {
    if (record.camera != camera && record.last_detected >= since)
      others.push_back(record.camera);
  }
  return others;
}

std::size_t Track::camerasShowing(double since) const {
  return std::count_if(records_.begin(), records_.end(), [&](const CameraRecord& record) {
    return record.last_detected_alone >= since;
  });
}

void Track::report(double time, const TrackerOptions& options, TrackedLed* led) const {
  motion::MotionFilter at_time = filter;
  at_time.predict(time);
  led->position = at_time.position();
  led->position_covariance = at_time.positionCovariance();
  led->velocity = at_time.velocity();
  led->velocity_covariance = at_time.velocityCovariance();
  led->id = id;
  led->first_seen = initiated_;
  led->last_observed = last_observed_;
  led->same_led_probability = same_led_probability_;
  const Visibility now = visibilityAt(time, options);
  led->rays_possible = now.expected;
  led->residual = std::sqrt(now.squared_residuals / now.detected);  // NaN: none
  const auto seen_since = [&](double since, CameraList* cameras) {
    cameras->clear();
    for (const CameraRecord& record : records_) {
      if (record.last_detected >= since)
        cameras->push_back(record.camera);
    }
    std::sort(cameras->begin(), cameras->end());
  };
  seen_since(time - options.tracked_time, &led->cameras);
  seen_since(std::min(time, last_located_) - options.tracked_time, &led->located_by);
  // Predicted: one camera alone does not measure the distance; the two cameras that see it may see
  // different lights; or no spot is near its prediction, as of a track that follows another light.
  const bool is_located = now.detected >= 2 && !isDoubtful(now.detected, now.in_view) &&
                          led->residual <= 2.0 * options.birth_pixel_stddev;
  led->state = !confirmed_  ? TrackState::kTentative
               : is_located ? TrackState::kTracked
                            : TrackState::kPredicted;
}

}  // namespace wiimote_tracker::tracking
