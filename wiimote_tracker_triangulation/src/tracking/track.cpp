#include "track.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr unsigned kRecentImages = 0xf;  // the last four

// Two tracks that share nearly all of about so many spots are of one LED; two LEDs that pass each
// other do so for fewer. What has long been alone is given longer.
constexpr double kShortMemory = 64.0;
constexpr double kLongMemory = 256.0;
constexpr double kLeastAlone = 0.15;
constexpr double kMostlyOwn = 0.7;

int bits(unsigned x) {
  int count = 0;
  for (; x; x &= x - 1)
    ++count;
  return count;
}

}  // namespace

Track::Track(const motion::MotionFilter& start, std::uint32_t led_id)
    : filter(start),
      id(led_id),
      born_(start.time()),
      started_(born_),
      last_observed_(born_),
      last_located_(born_),
      place_(start.position()),
      velocity_(Eigen::Vector3d::Zero()),
      place_time_(born_) {}

Look& Track::lookOf(std::size_t camera, double time) {
  for (std::size_t i = 0; i < look_count_; ++i) {
    if (looks_[i].camera == camera)
      return looks_[i];
  }
  std::size_t place = look_count_;
  if (look_count_ < kMaximumLooks) {
    ++look_count_;
  } else {
    const auto stalest = std::min_element(looks_.begin(), looks_.end(),
                                          [](auto& a, auto& b) { return a.time < b.time; });
    place = static_cast<std::size_t>(stalest - looks_.begin());
  }
  looks_[place] = Look();
  looks_[place].camera = camera;
  looks_[place].time = time;
  looks_[place].hit = looks_[place].own = -std::numeric_limits<double>::infinity();
  return looks_[place];
}

void Track::miss(std::size_t camera, double time) {
  Look& look = lookOf(camera, time);
  look.time = time;
  look.recent = look.recent << 1 & kRecentImages;
  ++misses_in_a_row_;
}

void Track::hit(std::size_t camera, const Eigen::Vector2d& residual, bool is_own) {
  const double time = filter.time();
  Look& look = lookOf(camera, time);
  look.time = time;
  look.hit = time;
  if (is_own)
    look.own = time;
  look.squared_residual = residual.squaredNorm();
  look.recent = (look.recent << 1 | 1) & kRecentImages;
  misses_in_a_row_ = 0;
  last_observed_ = time;
  place_ = filter.position();
  velocity_ = filter.velocity();
  place_time_ = time;
}

void Track::noteAlone() {
  ++hits_;
  alone_ += (1.0 - alone_) / kShortMemory;
}

void Track::noteShared(std::uint32_t other, bool is_own) {
  const double memory =
      std::min(std::max(0.5 * static_cast<double>(hits_), kShortMemory), kLongMemory);
  alone_ -= alone_ / memory;
  owned_ += ((is_own ? 1.0 : 0.0) - owned_) / kShortMemory;
  shares_with_ = other;
}

/// Whether it is another track's LED, of two that share all spots: the spots are mostly the
/// other's, or of both alike and the other is older.
bool Track::isAnother() const {
  return alone_ < kLeastAlone &&
         (owned_ < 1.0 - kMostlyOwn || (owned_ < kMostlyOwn && shares_with_ < id));
}

void Track::foundBy(std::size_t camera, double residual) {
  Look& look = lookOf(camera, filter.time());
  look.time = look.hit = look.own = filter.time();
  look.squared_residual = residual * residual;
  look.recent = 1;
}

void Track::restart(const motion::MotionFilter& start) {
  filter = start;
  started_ = last_observed_ = last_located_ = place_time_ = start.time();
  place_ = start.position();
  velocity_.setZero();
  misses_in_a_row_ = 0;
  look_count_ = 0;
}

void Track::judge(double time, const TrackerOptions& options) {
  std::size_t seen_by = 0;
  std::size_t possible = 0;
  for (std::size_t i = 0; i < look_count_; ++i) {
    possible += looks_[i].time >= time - options.tracked_time;
    seen_by += looks_[i].hit >= time - options.tracked_time;
  }
  if (seen_by >= 2)
    last_located_ = time;
  if (!place_.allFinite()) {
    over_ = true;
    return;
  }
  if (confirmed_) {
    over_ = time - last_observed_ > options.prediction_time ||
            time - last_located_ > options.single_view_time || isAnother();
    return;
  }
  const std::size_t supported = supporters(time, options);
  if (hits_ >= options.confirmation_hits && supported >= 2 &&
      static_cast<double>(supported) >= options.minimum_support * static_cast<double>(possible)) {
    confirmed_ = true;
    return;
  }
  constexpr double kLongestTrial = 0.5;  // [s]
  const double unseen = time - last_observed_;
  const double patience = options.tracked_time + options.dark_time;
  over_ =
      unseen > patience || time - last_located_ > patience ||
      (unseen >= options.dark_time && misses_in_a_row_ >= 2 * std::max<std::size_t>(possible, 2)) ||
      time - born_ > kLongestTrial + options.dark_time;
}

/// Cameras that showed it in two of their last four images.
std::size_t Track::supporters(double time, const TrackerOptions& options) const {
  return static_cast<std::size_t>(
      std::count_if(looks_.begin(), looks_.begin() + static_cast<std::ptrdiff_t>(look_count_),
                    [&](const Look& look) {
                      return look.time >= time - options.tracked_time && bits(look.recent) >= 2;
                    }));
}

Eigen::Vector3d Track::roughPlace(double time) const {
  return place_ + (time - place_time_) * velocity_;
}

bool Track::isShownBy(std::size_t camera, double time) const {
  return std::any_of(looks_.begin(), looks_.begin() + static_cast<std::ptrdiff_t>(look_count_),
                     [&](const Look& look) { return look.camera == camera && look.own == time; });
}

bool Track::isSeenBeside(std::size_t camera, double since) const {
  return std::any_of(looks_.begin(), looks_.begin() + static_cast<std::ptrdiff_t>(look_count_),
                     [&](const Look& look) { return look.camera != camera && look.hit >= since; });
}

std::size_t Track::showers(double since) const {
  return static_cast<std::size_t>(
      std::count_if(looks_.begin(), looks_.begin() + static_cast<std::ptrdiff_t>(look_count_),
                    [&](const Look& look) { return look.own >= since; }));
}

void Track::report(double time,
                   const TrackerOptions& options,
                   const std::vector<std::size_t>& rig_index,
                   TrackedLed* led) const {
  const auto fill = [&](const motion::MotionFilter& at_time) {
    led->position = at_time.position();
    led->position_covariance = at_time.positionCovariance();
    led->velocity = at_time.velocity();
    led->velocity_covariance = at_time.velocityCovariance();
  };
  if (filter.time() < time) {
    motion::MotionFilter later = filter;
    later.predict(time);
    fill(later);
  } else {
    fill(filter);
  }
  led->id = id;
  led->first_seen = born_;
  led->last_observed = last_observed_;
  led->cameras.clear();
  led->rays_possible = 0;
  double squares = 0.0;
  for (std::size_t i = 0; i < look_count_; ++i) {
    const Look& look = looks_[i];
    if (look.time < time - options.tracked_time)
      continue;
    ++led->rays_possible;
    if (look.hit < time - options.tracked_time)
      continue;
    led->cameras.push_back(rig_index[look.camera]);
    squares += look.squared_residual;
  }
  std::sort(led->cameras.begin(), led->cameras.end());
  // One camera alone does not see how far away it is.
  led->state = !confirmed_                ? TrackState::kTentative
               : led->cameras.size() >= 2 ? TrackState::kTracked
                                          : TrackState::kPredicted;
  led->residual = std::sqrt(squares / static_cast<double>(led->cameras.size()));  // NaN: none
}

}  // namespace wiimote_tracker::tracking
