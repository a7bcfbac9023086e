#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_EXPOSURE_CLOCK_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_EXPOSURE_CLOCK_H

#include "wiimote_tracker_driver/exposure_clock/clock_estimator.h"

#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Exposure times of a periodic camera from the arrival times of its reports, which carry no
/// counter and come late, in slots, in bursts or not at all. Causal; constant time and memory per
/// report.
///
/// A second estimator begins anew every few seconds. It replaces the first when it predicts the
/// arrivals better, which means that the first has a wrong period, or that it took slow changes of
/// the delays (as where polls beat with the camera) for the camera's own. A replaced estimator's
/// error grew from none to its distance from the new one, so its mean square is a third of the
/// distance's; the average of that over the last half minute is added to the stated variances.
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
  Estimate challenge(double arrival);
  void learnError(double error, double arrival);

  ClockEstimator leader_, challenger_;
  double trial_begin_;           ///< Of the challenger [s].
  double advantage_ = 0.0;       ///< Of the challenger: logarithm of a ratio of likelihoods.
  double leader_begin_;          ///< Arrival when it became the leader [s].
  double error_variance_ = 0.0;  ///< Average over replaced leaders and time since [s^2].
  double last_arrival_, last_exposure_;
  std::int64_t frame_offset_ = 0;  ///< Our frame number less the leader's.
  Statistics before_;              ///< Sums of earlier leaders, less those of challengers.
};

}  // namespace wiimote_tracker::exposure_clock

#endif
