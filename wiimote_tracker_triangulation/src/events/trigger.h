#pragma once

#include "wiimote_tracker_triangulation/tracking/numbered_queue.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace wiimote_tracker::events {

struct TriggerOptions {
  /// Longest interval between two snapshots for interpolation [s, > 0].
  double maximum_gap = 0.05;

  /// How long snapshots are kept, and the greatest lead of a request over the newest one [s, > 0].
  double history = 2.0;
};

enum class TriggerResult {
  kAnswered,
  kGap,       ///< The snapshots around that time are too far apart.
  kNoTime,    ///< At 0, before the oldest snapshot: the stamp was not set.
  kTooOld,    ///< Before the oldest snapshot.
  kTooEarly,  ///< Too far ahead of the newest snapshot.
  kTooMany,   ///< Trigger::kMaximumPending requests were waiting.
};

/// Why there is no answer, as the end of a sentence about the request.
std::string describe(TriggerResult result, const TriggerOptions& options);

struct TriggerAnswer {
  TriggerResult result = TriggerResult::kGap;
  std::uint64_t request = 0;    ///< As given to ask().
  tracking::Snapshot snapshot;  ///< At the requested time, without views; kAnswered only.
};

/// Interpolates an LED between two snapshots. The position is a cubic through both positions and
/// velocities, or a line where a velocity is missing; the velocity is linear. Its covariance is the
/// weighted mean of both, which bounds the true one for any correlation of their errors
/// ((1-s) a a' + s b b' >= ((1-s) a + s b)((1-s) a + s b)'), plus that of the velocities' errors as
/// if independent. Rays and residual are those of the nearer snapshot; the state is the less
/// certain one.
tracking::TrackedLed interpolate(const tracking::TrackedLed& before,
                                 double time_before,
                                 const tracking::TrackedLed& after,
                                 double time_after,
                                 double time);

/// Interpolates the LEDs to external times, such as those of a light barrier. An answer waits for
/// the first snapshot at or after its time, and depends on the snapshots only. It omits LEDs that
/// one of the two snapshots does not show, or shows as lost. Does not allocate once warm, except
/// for requests.
class Trigger {
 public:
  static constexpr std::size_t kMaximumPending = 256;

  explicit Trigger(const TriggerOptions& options) : options_(options) {}

  /// @param request an identifier that is returned with the answer.
  void ask(double time, std::uint64_t request);

  /// Snapshots in strictly increasing time, except after forget().
  void add(const tracking::Snapshot& snapshot);

  /// Forgets all snapshots; requests wait for the next one.
  void forget() { kept_.clear(); }

  /// The next answer; null when there is none. Every request is answered once. Valid until the next
  /// call. Call after each ask() and each add(), until it is null.
  const TriggerAnswer* next();

  /// Answers all waiting requests: there will be no more snapshots.
  void finish();

 private:
  struct Request {
    double time;
    std::uint64_t number;
    bool is_one_too_many;
  };

  bool answer(const Request& request);
  void answerBetween(const tracking::Snapshot& before, const tracking::Snapshot& after);

  TriggerOptions options_;
  tracking::NumberedQueue<tracking::Snapshot> kept_;  // without views
  bool finished_ = false;
  std::deque<Request> pending_;
  TriggerAnswer answer_;
};

}  // namespace wiimote_tracker::events
