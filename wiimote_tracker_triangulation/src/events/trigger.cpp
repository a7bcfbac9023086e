#include "events/trigger.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <limits>

namespace wiimote_tracker::events {
namespace {

using tracking::TrackedLed;
using tracking::TrackState;

TrackState lessCertain(TrackState a, TrackState b) {
  for (const TrackState state :
       {TrackState::kLost, TrackState::kTentative, TrackState::kPredicted}) {
    if (a == state || b == state)
      return state;
  }
  return TrackState::kTracked;
}

const TrackedLed* find(const std::vector<TrackedLed>& leds, std::uint32_t id) {
  const auto led =
      std::find_if(leds.begin(), leds.end(), [&](const TrackedLed& l) { return l.id == id; });
  return led == leds.end() ? nullptr : &*led;
}

}  // namespace

std::string describe(TriggerResult result, const TriggerOptions& options) {
  switch (result) {
    case TriggerResult::kAnswered:
      break;
    case TriggerResult::kGap:
      return format(
          "no images were used within %g s around it: check that the cameras' drivers run",
          options.maximum_gap);
    case TriggerResult::kNoTime:
      return "it carries no time: set the stamp of its header, with rostopic pub by '{stamp: now}'";
    case TriggerResult::kTooOld:
      return format(
          "it is older than the stored snapshots, at most %g s: ask sooner, and set all computers "
          "to the same clock",
          options.history);
    case TriggerResult::kTooEarly:
      return format(
          "it is more than %g s ahead of the images: check that the cameras' drivers run, and set "
          "all computers to the same clock",
          options.history);
    case TriggerResult::kTooMany:
      return "too many others wait for images: check that the cameras' drivers run";
  }
  return "";
}

TrackedLed interpolate(const TrackedLed& before,
                       double time_before,
                       const TrackedLed& after,
                       double time_after,
                       double time) {
  const double duration = time_after - time_before;
  const double s = (time - time_before) / duration;
  TrackedLed led = s <= 0.5 ? before : after;
  led.state = lessCertain(before.state, after.state);
  led.first_seen = before.first_seen;
  led.last_observed = std::max(before.last_observed, std::min(after.last_observed, time));
  if (!before.velocity || !after.velocity) {
    led.velocity.reset();
    led.position = (1.0 - s) * before.position + s * after.position;
    led.position_covariance =
        (1.0 - s) * before.position_covariance + s * after.position_covariance;
    return led;
  }
  // Cubic Hermite basis.
  const double weight = s * s * (3.0 - 2.0 * s);
  const double pull_before = duration * s * (1.0 - s) * (1.0 - s);
  const double pull_after = -duration * s * s * (1.0 - s);
  led.position = (1.0 - weight) * before.position + weight * after.position +
                 pull_before * *before.velocity + pull_after * *after.velocity;
  led.position_covariance = (1.0 - weight) * before.position_covariance +
                            weight * after.position_covariance +
                            pull_before * pull_before * before.velocity_covariance +
                            pull_after * pull_after * after.velocity_covariance;
  led.velocity = (1.0 - s) * *before.velocity + s * *after.velocity;
  led.velocity_covariance = (1.0 - s) * before.velocity_covariance + s * after.velocity_covariance;
  return led;
}

void Trigger::ask(double time, std::uint64_t request) {
  pending_.push_back({time, request, pending_.size() >= kMaximumPending});
}

void Trigger::add(const tracking::Snapshot& snapshot) {
  while (kept_.size() > 1 && kept_.at(kept_.begin() + 1).time < snapshot.time - options_.history)
    kept_.popFront();
  tracking::Snapshot& kept = kept_.push();
  kept.time = snapshot.time;
  kept.latest_arrival = snapshot.latest_arrival;
  kept.skew = snapshot.skew;
  kept.leds = snapshot.leds;
}

const TriggerAnswer* Trigger::next() {
  for (auto request = pending_.begin(); request != pending_.end(); ++request) {
    if (!answer(*request))
      continue;
    pending_.erase(request);
    return &answer_;
  }
  return nullptr;
}

void Trigger::finish() {
  finished_ = true;
}

bool Trigger::answer(const Request& request) {
  answer_.request = request.number;
  answer_.snapshot.time = request.time;
  answer_.snapshot.leds.clear();
  const double newest =
      kept_.empty() ? -std::numeric_limits<double>::infinity() : kept_.back().time;
  if (request.is_one_too_many) {
    answer_.result = TriggerResult::kTooMany;
  } else if (!kept_.empty() && request.time > newest + options_.history) {
    answer_.result = TriggerResult::kTooEarly;
  } else if (request.time > newest || kept_.empty()) {
    answer_.result = TriggerResult::kGap;
    return finished_;
  } else if (request.time < kept_.front().time) {
    answer_.result = request.time == 0.0 ? TriggerResult::kNoTime : TriggerResult::kTooOld;
  } else {
    std::uint64_t number = kept_.begin();
    while (kept_.at(number).time < request.time)
      ++number;
    const tracking::Snapshot& after = kept_.at(number);
    const tracking::Snapshot& before = after.time == request.time ? after : kept_.at(number - 1);
    answer_.result = after.time - before.time <= options_.maximum_gap ? TriggerResult::kAnswered
                                                                      : TriggerResult::kGap;
    if (answer_.result == TriggerResult::kAnswered)
      answerBetween(before, after);
  }
  return true;
}

void Trigger::answerBetween(const tracking::Snapshot& before, const tracking::Snapshot& after) {
  tracking::Snapshot& snapshot = answer_.snapshot;
  snapshot.latest_arrival = std::max(before.latest_arrival, after.latest_arrival);
  snapshot.skew = std::max(before.skew, after.skew);
  for (const TrackedLed& led : before.leds) {
    const TrackedLed* later = find(after.leds, led.id);
    if (!later || lessCertain(led.state, later->state) == TrackState::kLost)
      continue;
    snapshot.leds.push_back(before.time == after.time
                                ? led
                                : interpolate(led, before.time, *later, after.time, snapshot.time));
  }
}

}  // namespace wiimote_tracker::events
