#pragma once

#include "exposure_clock/clock_filter.h"

#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// What a link does to a report besides its usual delay: a stall holds it up, for a time that is
/// distributed exponentially, and those behind it wait in a queue. How often stalls come and how
/// long they last is learnt.
class StallModel {
 public:
  /// Density of an arrival that no model explains [1/s]; a stall explains delays up to 0.3 s.
  static constexpr double kUnexplained = 1e-7;

  struct Arrival {
    double time;    ///< [s]
    double before;  ///< of the report before [s]
    bool waited;    ///< for the reader: it arrived at an unknown time before `time`
  };

  /// Of an arrival [1/s]: the report was on time, waited behind the one before, or was held up.
  struct Density {
    double late;  ///< behind the least delay [s]
    double on_time, queued, stalled;
    double sum() const { return on_time + queued + stalled + kUnexplained; }
  };
  /// Of a report of this frame, if the filter is right.
  Density density(const ClockFilter& filter, std::int64_t frame, const Arrival& arrival) const;

  /// A step of expectation maximisation, with a report that did not wait for the reader.
  void learn(const Density& density);

 private:
  // They begin as in recordings of two remotes.
  double probability_ = 0.02;           ///< That a stall holds a report up.
  double time_ = probability_ * 0.020;  ///< Of stalls, averaged over all reports [s].
  double reports_ = 0.0;                ///< That both are estimated from.
};

}  // namespace wiimote_tracker::exposure_clock
