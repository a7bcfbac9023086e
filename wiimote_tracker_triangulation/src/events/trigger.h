#ifndef WIIMOTE_TRACKER_TRIANGULATION_EVENTS_TRIGGER_H
#define WIIMOTE_TRACKER_TRIANGULATION_EVENTS_TRIGGER_H

#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace wiimote_tracker::events {

struct TriggerOptions {
  /// LEDs are interpolated between two snapshots no further apart than this [s, > 0].
  double maximum_gap = 0.05;

  /// How long snapshots are kept, and how far ahead of the newest one a request may lie [s, > 0].
  double history = 2.0;
};

enum class TriggerResult {
  kAnswered,
  kGap,       ///< No snapshots closely enough around that time.
  kTooOld,    ///< Before all that is kept.
  kTooEarly,  ///< Too far ahead of the newest snapshot.
  kTooMany,   ///< Asked while Trigger::kMaximumPending others waited.
};

/// For people: why there is no answer, in words that end a sentence about the request.
std::string describe(TriggerResult result, const TriggerOptions& options);

struct TriggerAnswer {
  TriggerResult result = TriggerResult::kGap;
  std::uint64_t request = 0;    ///< The number given to ask().
  tracking::Snapshot snapshot;  ///< At the time asked for, without views; kAnswered only.
};

/// The LED at a time between (or at one of) those of two snapshots that show it. The position is a
/// cubic through both positions and velocities, or a straight line where a velocity is missing. Its
/// covariance, the weighted mean of both, is never too small however the errors of the two are
/// correlated ((1-s) a a' + s b b' >= ((1-s) a + s b)((1-s) a + s b)'); what the velocities' errors
/// add is added to it as if independent. Rays and residual are those of the nearer snapshot, the
/// state is the less certain one.
tracking::TrackedLed interpolate(const tracking::TrackedLed& before,
                                 double time_before,
                                 const tracking::TrackedLed& after,
                                 double time_after,
                                 double time);

/// Answers "where were the LEDs at that time" for times that come from outside, such as those of a
/// light barrier. An answer waits for the first snapshot at or after its time; it depends on the
/// snapshots only, not on when it was asked for. An LED that one of the two snapshots does not
/// show, or shows as lost, is not in the answer. Does not allocate once warm, but for requests.
class Trigger {
 public:
  static constexpr std::size_t kMaximumPending = 256;

  explicit Trigger(const TriggerOptions& options) : options_(options) {}

  /// `request`: a number of the caller's own that comes back with the answer.
  void ask(double time, std::uint64_t request);

  /// Snapshots in strictly increasing time. When time goes back, what was kept is forgotten.
  void add(const tracking::Snapshot& snapshot);

  /// The next answer; null when there is none. Every request is answered once. Valid until the next
  /// call. Call after each ask() and each add(), until it is null.
  const TriggerAnswer* next();

  /// Answers all that still wait: nothing more will come.
  void finish();

 private:
  struct Request {
    double time;
    std::uint64_t number;
    bool is_one_too_many;
  };

  struct Kept {
    double time = 0.0;
    double latest_arrival = 0.0;
    double skew = 0.0;
    std::vector<tracking::TrackedLed> leds;
  };

  const Kept& at(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  bool answer(const Request& request);
  void answerBetween(const Kept& before, const Kept& after);

  TriggerOptions options_;
  std::vector<Kept> ring_;  // its elements keep their memory
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  bool finished_ = false;
  std::deque<Request> pending_;
  TriggerAnswer answer_;
};

}  // namespace wiimote_tracker::events

#endif  // WIIMOTE_TRACKER_TRIANGULATION_EVENTS_TRIGGER_H
