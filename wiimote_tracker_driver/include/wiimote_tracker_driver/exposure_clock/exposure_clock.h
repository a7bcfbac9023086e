#pragma once

#include <cstdint>
#include <memory>

namespace wiimote_tracker::exposure_clock {

class ClockEstimator;
class PollWatch;

constexpr double kNominalPeriod = 0.010035;  ///< between frames of a Wii Remote [s]

/// Estimate from the arrivals up to one report. Exposure times are late by the constant part of the
/// delay, which cannot be estimated.
struct Estimate {
  double exposure =
      0.0;              ///< on the clock of the arrivals; later than that of the report before [s]
  double stddev = 0.0;  ///< of exposure, including the uncertain frame number [s]
  double clock_stddev = 0.0;  ///< of exposure, given the frame number [s]
  std::int64_t frame = 0;  ///< most probable frame number; later reports may correct it downwards
  bool stale = false;      ///< arrived more than 30 ms late, e.g. after a stall
  bool restarted = false;  ///< the phase was lost, and is estimated anew from this report on
};

/// For diagnostics.
struct Statistics {
  double period = 0.0;         ///< [s]
  double period_stddev = 0.0;  ///< [s]
  double jitter = 0.0;         ///< standard deviation of the delays, without queues [s]
  double exponential = 0.0;    ///< probability that delays are exponentially distributed, 0..1
  /// Frames lost since reset(), as far as known now, less reports of a frame that had one already.
  std::int64_t dropped = 0;
  std::uint64_t reports = 0, stale = 0, restarts = 0;  ///< since reset()
};

/// Exposure times of a periodic camera from the arrival times of its reports, which carry no
/// counter and come late, in slots, in bursts or not at all. Causal; constant time and memory per
/// report.
///
/// A second estimator begins anew when it has not got ahead for a while (a sequential test by the
/// ratio of likelihoods: Wald, Ann. Math. Stat. 16, 1945); from the first it takes only how often
/// images are lost or held up. It replaces the first when it predicts the arrivals better, which
/// means that the first has a wrong period, or that it took slow changes of the delays (as where
/// polls beat with the camera) for the camera's own. A replaced estimator's error grew from none to
/// its distance from the new one, so its mean square is a third of the distance's; the average of
/// that over the last half minute is added to the stated variances, and so is the variance of waits
/// for polls that are in step with the camera.
class ExposureClock {
 public:
  /// @param period nominal time between frames [s]. @throws std::invalid_argument when it is not
  /// above 0.
  explicit ExposureClock(double period = kNominalPeriod);
  ~ExposureClock();
  ExposureClock(ExposureClock&&) noexcept;
  ExposureClock& operator=(ExposureClock&&) noexcept;

  /// Takes a report's arrival [s], best on a steady clock. An arrival before the previous one by
  /// more than a millisecond restarts the clock. `waited`: it arrived at an unknown time before
  /// that. @throws std::invalid_argument when it is not finite.
  Estimate update(double arrival, bool waited = false);

  /// Forgets everything: a new epoch.
  void reset();

  Statistics statistics() const;

 private:
  Estimate challenge(double arrival, bool waited);
  void endTrial();
  void learnError(double error, double arrival);

  std::unique_ptr<ClockEstimator> leader_, challenger_;
  std::unique_ptr<PollWatch> polls_;
  double trial_begin_ = 0.0;     ///< Of the challenger [s].
  double advantage_ = 0.0;       ///< Of the challenger: logarithm of a ratio of likelihoods,
  double best_advantage_ = 0.0;  ///< its greatest value, in steps of kProgress,
  double progressed_at_;         ///< and when it reached that [s].
  double leader_begin_;          ///< Arrival when it became the leader [s].
  double error_variance_ = 0.0;  ///< Average over replaced leaders and time since [s^2].
  double last_arrival_, last_exposure_;
  std::int64_t frame_offset_ = 0;  ///< Our frame number less the leader's.
  Statistics counts_;              ///< Its other members are unused.
};

}  // namespace wiimote_tracker::exposure_clock
