#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_CLOCK_ESTIMATOR_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_CLOCK_ESTIMATOR_H

#include "exposure_clock/clock_filter.h"
#include "exposure_clock/frame_counter.h"
#include "exposure_clock/frame_history.h"
#include "exposure_clock/steady_edge.h"
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Between two exposures, where a frame number was corrected downwards [s].
constexpr double kShortestStep = 1e-6;

/// One attempt at the exposure times of a camera: if it begins with wrong frame numbers, it may
/// keep a wrong period. ExposureClock leaves such an attempt.
///
/// A bank of ClockFilters, one per delay model, weighted by their likelihoods (multiple model
/// estimation: Magill, IEEE Trans. Autom. Control 10, 1965). One FrameCounter for all estimates the
/// frame numbers. With a sharp edge and a steady clock the posterior is far from normal; SteadyEdge
/// computes it exactly after a few seconds.
class ClockEstimator {
 public:
  /// @param period nominal time between frames [s]. @throws std::invalid_argument when it is not
  /// above 0.
  explicit ClockEstimator(double period);

  /// Takes a report's arrival [s], best on a steady clock. An arrival before the previous one by
  /// more than a millisecond restarts the clock. `waited`: it arrived at an unknown time before
  /// that. @throws std::invalid_argument when it is not finite.
  Estimate update(double arrival, bool waited = false);

  /// Copies what is known about stalls and losses of the link.
  void copyLinkFrom(const ClockEstimator& other);

  double nominalPeriod() const { return period_; }
  /// Its counts are 0: ExposureClock counts.
  Statistics statistics() const;

  /// Logarithm of the density [1/s] that was predicted for the latest arrival.
  double logEvidence() const { return log_evidence_; }

 private:
  static constexpr int kModels = 9;
  using Bank = std::array<ClockFilter, kModels>;
  static Bank makeBank(double period);

  Estimate restart(double arrival, std::int64_t frame);
  struct Arrival;
  static Arrival arrivalAfter(double before, double time, bool waited = false);
  struct ArrivalDensity;
  ArrivalDensity arrivalDensity(const ClockFilter& filter,
                                const Arrival& arrival,
                                double offset) const;
  void updateModels(double arrival, bool waited);
  void learnFromHistory(double arrival, double on_time);
  void learnStalls(const ArrivalDensity& density);
  void applySteadyEdge();
  void reinitialiseUnlikelyModels();
  Estimate estimate(double arrival);
  const ClockFilter& best() const;

  double period_;  // nominal [s]
  Bank filters_;
  FrameHistory history_;
  SteadyEdge edge_;  // exact state of the filter for a sharp edge and a steady clock
  bool edge_used_ = false;
  double stall_probability_;   // that a report is held up,
  double stall_time_;          // for how long, averaged over all reports [s],
  double sample_count_ = 0.0;  // and number of reports used for both
  std::array<double, kModels> weights_;
  FrameCounter counter_;
  // Internal times are relative to the first arrival, for precision.
  double origin_ = 0.0;
  double last_arrival_ = 0.0, last_exposure_ = 0.0;
  std::int64_t frame_ = 0;  // of the filters' states: the latest report's most probable number
  int unexplained_ = 0;     // reports in a row that no model expected
  int uncertain_ = 0;       // reports in a row with a stddev above one period
  double log_evidence_ = 0.0;
  bool running_ = false;
};

}  // namespace wiimote_tracker::exposure_clock

#endif
