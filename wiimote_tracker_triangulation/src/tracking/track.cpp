#include "track.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {

Track::Track(const motion::MotionFilter& start, std::uint32_t id)
    : id_(id),
      filter_(start),
      initiated_(start.time()),
      started_(initiated_),
      last_observed_(initiated_),
      last_located_(initiated_),
      position_(start.position()),
      velocity_(Eigen::Vector3d::Zero()),
      position_time_(initiated_) {}

Eigen::Vector3d Track::approximatePosition(double time) const {
  return position_ + (time - position_time_) * velocity_;
}

void Track::addInitialSpot(std::size_t camera, double time, double residual) {
  cameras_.hit(camera, time, residual * residual, true);
  started_ = std::min(started_, time);
  ++initial_spots_;
}

void Track::hit(std::size_t camera,
                const Eigen::Vector2d& residual,
                const Track* other,
                bool is_own) {
  const double time = filter_.time();
  cameras_.hit(camera, time, residual.squaredNorm(), is_own);
  misses_in_a_row_ = 0;
  last_observed_ = time;
  position_ = filter_.position();
  velocity_ = filter_.velocity();
  position_time_ = time;
  if (other)
    shares_.addMerged(other->id_, is_own);
  else
    shares_.addAlone();
}

void Track::miss(std::size_t camera, double time) {
  cameras_.miss(camera, time);
  ++misses_in_a_row_;
}

void Track::updateStatus(double time, const TrackerOptions& options, bool in_crowd) {
  const Visibility now = cameras_.visibility(time - options.tracked_time);
  if (now.detected >= 2)
    last_located_ = time;
  agreement_.update(now, options.pixel_stddev, time);
  if (!position_.allFinite())
    finished_ = true;
  else if (confirmed_)
    updateConfirmed(time, options);
  else
    updateTentative(now, time, options, in_crowd);
}

void Track::updateConfirmed(double time, const TrackerOptions& options) {
  finished_ = time - last_observed_ > options.prediction_time ||
              time - last_located_ > options.single_view_time || isDuplicate();
}

/// In a crowd, nobody is confirmed where only two cameras look: facing ones often show a light each
/// whose rays meet.
void Track::updateTentative(const Visibility& now,
                            double time,
                            const TrackerOptions& options,
                            bool in_crowd) {
  constexpr double kMaximumTentativeTime = 0.5;  // [s]
  // Two or three false detections may form a point; a fourth hardly ever is near it.
  constexpr std::size_t kReacquisitionSpots = 4;
  const std::size_t hits = shares_.alone();
  const bool is_supported =
      now.supporting >= 2 && now.supporting >= options.minimum_support * now.expected;
  const bool may_be_phantom = mayBePhantom(now.supporting, now.in_view);
  const double limit = options.birth_pixel_stddev;
  may_reacquire_ = initial_spots_ + hits >= kReacquisitionSpots &&
                   now.squared_residuals <= now.detected * limit * limit &&
                   (now.detected >= 3 || (is_supported && agreement_.areNowOne()));
  confirmed_ = is_supported && hits >= options.confirmation_hits && !may_be_phantom &&
               !(in_crowd && now.in_view == 2);
  const double unseen = time - last_observed_;
  const double unlocated = time - last_located_;
  const double patience = options.tracked_time + options.dark_time;
  // Each camera that should show it, and at least two, missed it twice.
  const bool is_missed =
      unseen >= options.dark_time && misses_in_a_row_ >= 2 * std::max<std::size_t>(now.expected, 2);
  const bool is_too_old =
      time - initiated_ > kMaximumTentativeTime + options.dark_time && !may_be_phantom;
  finished_ = !confirmed_ && (unseen > patience || unlocated > patience || is_missed || is_too_old);
}

/// Whether only two cameras see it of more that have it in view, and these two may see different
/// lights.
bool Track::mayBePhantom(std::size_t seen_by, std::size_t in_view) const {
  return seen_by == 2 && in_view > 2 && !agreement_.areLikelyOne();
}

void Track::continueAs(const Track& newer) {
  Track result = newer;
  result.id_ = id_;
  result.initiated_ = initiated_;
  result.same_led_probability_ = same_led_probability_;
  result.crowd_ = crowd_;
  result.confirmed_ = true;
  result.agreement_.reacquire();
  *this = result;
}

void Track::report(double time, const TrackerOptions& options, TrackedLed* led) const {
  motion::MotionFilter at_time = filter_;
  at_time.predict(time);
  led->position = at_time.position();
  led->position_covariance = at_time.positionCovariance();
  led->velocity = at_time.velocity();
  led->velocity_covariance = at_time.velocityCovariance();
  led->id = id_;
  led->first_seen = initiated_;
  led->last_observed = last_observed_;
  led->same_led_probability = same_led_probability_;
  const Visibility now = cameras_.visibility(time - options.tracked_time);
  led->rays_possible = now.expected;
  led->residual = std::sqrt(now.squared_residuals / now.detected);  // NaN: none
  led->cameras = cameras_.detecting(time - options.tracked_time);
  led->located_by = cameras_.detecting(std::min(time, last_located_) - options.tracked_time);
  for (CameraList* cameras : {&led->cameras, &led->located_by})
    std::sort(cameras->begin(), cameras->end());
  // Predicted: one camera alone does not measure the distance; the two cameras that see it may see
  // different lights; or no spot is near its prediction, as of a track that follows another light.
  const bool is_located = now.detected >= 2 && !mayBePhantom(now.detected, now.in_view) &&
                          led->residual <= 2.0 * options.birth_pixel_stddev;
  led->state = !confirmed_  ? TrackState::kTentative
               : is_located ? TrackState::kTracked
                            : TrackState::kPredicted;
}

}  // namespace wiimote_tracker::tracking
