#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_EXPOSURE_CLOCK_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_EXPOSURE_CLOCK_H

#include "wiimote_tracker_driver/exposure_clock/clock_filter.h"
#include "wiimote_tracker_driver/exposure_clock/frame_counter.h"

#include "wiimote_tracker_driver/exposure_clock/frame_history.h"
#include "wiimote_tracker_driver/exposure_clock/steady_edge.h"

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

struct ExposureClockOptions {
  double period = 0.010035;  ///< nominal time between frames [s], > 0
  double period_stddev =
      2500e-6;  ///< its standard deviation, relative, > 0; three times this is the limit
  double stale_age = 0.030;  ///< a report later than this is stale [s], > 0
};

/// What one report's arrival says. Exposure times are late by the constant part of the delay, which
/// no arrival can tell.
struct Estimate {
  double exposure =
      0.0;              ///< on the clock of the arrivals; later than that of the report before [s]
  double stddev = 0.0;  ///< of exposure, with the doubt which frame this is [s]
  double clock_stddev = 0.0;  ///< of exposure, were it sure which frame this is [s]
  std::int64_t frame = 0;     ///< most probable number of the frame; corrected backwards at times
  int dropped = 0;     ///< frames lost between the previous report and this one, as it looks now
  bool stale = false;  ///< waited in a queue: arrived more than stale_age after its time
  bool restarted = false;  ///< the phase was lost and is learnt anew from this report on
};

/// For diagnostics.
struct Statistics {
  double period = 0.0;         ///< [s]
  double period_stddev = 0.0;  ///< [s]
  double jitter = 0.0;         ///< standard deviation of the delays, without queues [s]
  double hard_edge = 0.0;      ///< probability that the delays have a hard lower edge, 0..1
  /// Frames lost since reset(), as far as known now, less reports of a frame that had one already.
  std::int64_t dropped = 0;
  std::uint64_t reports = 0, stale = 0, restarts = 0;  ///< since reset()
};

/// Exposure times of a periodic camera from the arrival times of its reports, which carry no
/// counter and come late, in slots, in bursts or not at all. Causal; constant time and memory per
/// report.
///
/// A bank of ClockFilters, one per delay model, each weighted by how well it predicts the arrivals
/// (multiple model estimation: Magill, IEEE Trans. Autom. Control 10, 1965); one FrameCounter
/// shared by all tells which frame a report is. The belief of the model for a sharp edge and a
/// steady clock is far from normal; SteadyEdge computes it exactly once it has seen a few seconds.
class ExposureClock {
 public:
  /// @throws std::invalid_argument when an option is out of range.
  explicit ExposureClock(const ExposureClockOptions& options = {});

  /// Takes a report's arrival [s], best on a steady clock. An arrival before the previous one by
  /// more than a millisecond restarts the clock. @throws std::invalid_argument when it is not
  /// finite.
  Estimate update(double arrival);

  /// Forgets everything: a new epoch.
  void reset();

  Statistics statistics() const;

 private:
  static constexpr int kModels = 9;
  using Bank = std::array<ClockFilter, kModels>;
  static Bank makeBank(const ExposureClockOptions& options);

  Estimate restart(double arrival, std::int64_t frame);
  struct Ways;
  Ways waysOf(const ClockFilter& filter,
              double arrival,
              double arrival_before,
              double offset) const;
  void weigh(double arrival);
  void lookBack(double arrival, double on_time);
  void learnStalls(const Ways& ways);
  void sharpenEdge();
  void reviveLosers();
  Estimate estimate(double arrival);
  const ClockFilter& best() const;

  ExposureClockOptions options_;
  Bank filters_;
  FrameHistory history_;
  SteadyEdge edge_;  // what the filter for a sharp edge and a steady clock believes
  bool edge_joined_ = false;
  // Of the latest report of which lookBack() has taken notice:
  double settled_arrival_ = 0.0;
  std::int64_t settled_frame_ = 0;
  double stalls_;            // probability that a report is held up,
  double experience_ = 0.0;  // and number of reports that taught it
  std::array<double, kModels> weights_;
  FrameCounter counter_;
  // Times inside are relative to the first arrival, which keeps their digits.
  double origin_ = 0.0;
  double last_arrival_ = 0.0, last_exposure_ = 0.0;
  std::int64_t frame_ = 0;  // where the filters stand: the latest report's most probable number
  int unexplained_ = 0;     // reports in a row that no model expected
  int doubtful_ = 0;        // reports in a row whose exposure is not known to a period
  bool running_ = false;
  Statistics statistics_;
};

}  // namespace wiimote_tracker::exposure_clock

#endif
