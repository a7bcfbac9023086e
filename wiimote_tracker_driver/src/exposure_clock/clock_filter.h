#pragma once

#include "exposure_clock/exact_posterior.h"

#include <cstdint>
#include <optional>

namespace wiimote_tracker::exposure_clock {

/// The least value of an exponential distribution is its mean less its standard deviation. That of
/// normally distributed delays is taken to be their mean less this [s].
constexpr double kTypicalNormalSpread = 0.0024;

/// Assumptions of a ClockFilter about delays and clock. The spread of the delays is estimated.
struct DelayModel {
  /// True: constant + exponential of mean `spread`. False: normal of standard deviation `spread`.
  bool exponential = true;
  /// Standard deviation of a normal error added to the exponential, e.g. by the link's slots [s].
  double blur = 0.0;
  /// Random walk of the camera's phase: standard deviation after one second [s].
  double wander = 0.0;
  /// Use ExactPosterior: for an exponential without blur and a clock that hardly wanders.
  bool exact = false;
};

/// Gaussian estimate of phase and period of a periodic camera, from arrivals under one delay model.
///
/// Arrival = z + e with z = exposure + constant + normal error, and e exponential (0 if delays are
/// normal). Given the arrival, z is a truncated normal; its first two moments are kept (assumed
/// density filtering: Maybeck, Stochastic Models, Estimation and Control, vol. 2, 1982, ch. 12;
/// moments: Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions, vol. 1, 1994,
/// eq. 13.134). With normal delays this is the Kalman filter. With exponential ones of a steady
/// clock the posterior is far from normal: ExactPosterior computes it exactly after a few seconds.
class ClockFilter {
 public:
  /// @param period nominal [s]. @param period_stddev of it [s]; estimates stay within three times
  /// this.
  ClockFilter(const DelayModel& model, double period, double period_stddev);

  /// Resets the phase: the state is now that of `frame`, which arrived at `arrival` [s].
  void start(std::int64_t frame, double arrival);
  /// Predicts the state of `frame`; of an earlier one without removing process noise.
  void advanceTo(std::int64_t frame);

  /// Exposure of the state's frame plus a constant: the least delay of exponential ones, else the
  /// mean delay less a typical spread [s].
  double time() const;
  double timeVariance() const { return state_.p00; }
  double period() const { return state_.period; }
  double periodVariance() const { return state_.p11; }
  /// Standard deviation of the delays [s].
  double spread() const { return spread_; }
  const DelayModel& model() const { return model_; }

  /// Of a frame's z [s], and how the state follows it.
  struct Prediction {
    double exposure;  ///< As time().
    double mean, variance, stddev;
    double time_gain, period_gain;
  };
  Prediction predict(std::int64_t frame) const;
  /// Density [1/s] of an arrival of this frame at `arrival`.
  double likelihood(const Prediction& frame, double arrival) const;
  /// Probability that this frame was ready to arrive before `time`: the integral of likelihood().
  double readyBefore(const Prediction& frame, double time) const;

  /// Sums over the hypotheses of one arrival.
  struct Hypotheses {
    double weight = 0.0;
    double time = 0.0, period = 0.0;
    double p00 = 0.0, p01 = 0.0, p11 = 0.0;
    double spread = 0.0;
  };
  /// Probabilistic data association (Bar-Shalom, Tse, Automatica 11, 1975): adds the hypothesis, of
  /// probability `weight`, that `arrival` is that of this frame.
  void addHypothesis(const Prediction& frame,
                     double arrival,
                     double weight,
                     Hypotheses* sums) const;
  /// Updates the state with all hypotheses of an arrival.
  void apply(const Hypotheses& sums);

  /// A report whose number is certain by now, and the probability that it came without waiting.
  void learn(std::int64_t frame, double arrival, double on_time);
  /// Copies phase, period and spread of a filter that explains the arrivals better.
  void follow(const ClockFilter& better);

 private:
  /// Whether the state is that of ExactPosterior.
  bool exact() const { return posterior_ && posterior_->ready(); }
  /// False also where the exponential is negligible beside the uncertainty.
  bool hasExponential(const Prediction& z) const;
  void learnSpread(const Hypotheses& sums);

  DelayModel model_;
  double nominal_period_, period_tolerance_;
  std::int64_t frame_ = 0;  // of the state
  ClockState state_;
  double spread_;
  double reports_ = 0.0;  // number used for the spread
  std::optional<ExactPosterior> posterior_;
};

}  // namespace wiimote_tracker::exposure_clock
