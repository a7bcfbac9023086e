#pragma once

#include "exposure_clock/filter_bank.h"
#include "exposure_clock/frame_counter.h"
#include "exposure_clock/frame_history.h"
#include "exposure_clock/stall_model.h"
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// One attempt at the exposure times of a camera: if it begins with wrong frame numbers, it may
/// keep a wrong period. ExposureClock leaves such an attempt.
///
/// FrameCounter says which frame a report may be, FilterBank when each of them was exposed, and
/// StallModel whether the report was held up. A few reports later FrameHistory tells the number for
/// certain, and the models learn from it.
///
/// Constants of these classes without a source are not critical: half of each or twice as much
/// changes the RMS error of each kind of link, simulated as in benchmark_timing, by at most 5 %.
class ClockEstimator {
 public:
  /// @param period nominal time between frames [s]. @throws std::invalid_argument when it is not
  /// above 0.
  explicit ClockEstimator(double period);

  /// As ExposureClock::update().
  Estimate update(double arrival, bool waited);

  /// Copies what is known about the link's stalls and losses, and that it is known. Not its delays:
  /// if the other one has taken the clock's changes for theirs, or theirs for the clock's, this one
  /// shall find it.
  void copyLinkFrom(const ClockEstimator& other);

  double nominalPeriod() const { return period_; }
  /// Its counts are 0: ExposureClock counts.
  Statistics statistics() const;

  /// Logarithm of the density [1/s] that was predicted for the latest arrival.
  double logEvidence() const { return log_evidence_; }

 private:
  Estimate restart(double arrival, std::int64_t frame);
  void learnFromHistory();
  Estimate estimate(double arrival);

  double period_;  // nominal [s]
  FilterBank filters_;
  StallModel stalls_;
  FrameCounter counter_;
  FrameHistory history_;
  // Internal times are relative to the first arrival, for precision.
  double origin_ = 0.0;
  double last_arrival_ = 0.0;
  std::int64_t frame_ = 0;  // of the filters' states: the latest report's most probable number
  int uncertain_ = 0;       // reports in a row with a stddev above one period
  double log_evidence_ = 0.0;
  bool running_ = false;
};

}  // namespace wiimote_tracker::exposure_clock
