#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_CLOCK_FILTER_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_CLOCK_FILTER_H

namespace wiimote_tracker::exposure_clock {

/// Time of a frame and period of the clock, with their covariance.
struct ClockState {
  double time = 0.0, period = 0.0;         ///< [s]
  double p00 = 0.0, p01 = 0.0, p11 = 0.0;  ///< [s^2]
};

/// What a ClockFilter believes about delays and clock. The spread of the delays is learnt.
struct DelayModel {
  /// True: least delay + exponential of mean `spread`. False: normal of standard deviation
  /// `spread`.
  bool hard_edge = true;
  /// Standard deviation of a normal error on top of a hard edge, e.g. from the link's slots [s].
  double blur = 0.0;
  /// Random walk of the camera's phase: standard deviation after one second [s].
  double wander = 0.0;
};

/// Phase and period of a periodic camera as a Gaussian belief, learnt from arrivals under one delay
/// model.
///
/// Arrival = z + e with z = exposure + least delay + normal error, and e exponential (0 without a
/// hard edge). Given the arrival, z is a normal that is tilted upwards by the exponential and cut
/// off at the arrival; its first two moments are kept (assumed density filtering: Maybeck,
/// Stochastic Models, Estimation and Control, vol. 2, 1982, ch. 12; moments of the truncated
/// normal: Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions, vol. 1, 1994,
/// eq. 13.134). Without a hard edge this is the Kalman filter.
class ClockFilter {
 public:
  /// @param period nominal [s]. @param period_stddev of it [s]; learnt periods stay within
  /// three times this.
  ClockFilter(const DelayModel& model, double period, double period_stddev);

  /// Forgets the phase: the belief now stands at a frame that arrived at `arrival` [s].
  void start(double arrival);
  /// Moves the belief `frames` periods on; back again when negative, which undoes no wander.
  void advance(double frames);

  /// Exposure time of the frame at which the belief stands, later by a constant: the least delay
  /// with a hard edge, else the mean delay less a typical spread. [s]
  double time() const;
  double timeVariance() const { return state_.p00; }
  double period() const { return state_.period; }
  double periodVariance() const { return state_.p11; }
  /// Standard deviation of the delays [s].
  double spread() const { return spread_; }
  const DelayModel& model() const { return model_; }

  /// Density [1/s] of an arrival at `arrival` of the frame `offset` frames after the belief's.
  double likelihood(double arrival, double offset) const;
  /// Probability that this frame was ready to arrive before `time`.
  double readyBefore(double time, double offset) const;

  /// Weighs in that `arrival` belongs, with probability `weight`, to the frame `offset` frames
  /// after the belief's. Called for all possibilities of one arrival, then settle() (probabilistic
  /// data association: Bar-Shalom, Tse, Automatica 11, 1975).
  void consider(double arrival, double offset, double weight);
  void settle();

  /// Replaces phase and period by what a better method found for the frame at which the belief
  /// stands.
  void believe(const ClockState& state) { state_ = state; }
  /// Takes phase, period and spread over from a filter that explains the arrivals better.
  void follow(const ClockFilter& better);

 private:
  struct Prediction {
    double mean, variance, stddev;  // of z
    double time_gain, period_gain;
  };
  Prediction predict(double offset) const;
  /// False also where the exponential vanishes beside the uncertainty.
  bool tilted(const Prediction& z) const;
  void learnSpread();

  DelayModel model_;
  double nominal_period_, period_tolerance_;
  ClockState state_;
  double spread_;
  double experience_ = 0.0;  // number of reports that taught the spread
  // Sums over the possibilities of one arrival.
  struct Sums {
    double weight = 0.0;
    double time = 0.0, period = 0.0;
    double p00 = 0.0, p01 = 0.0, p11 = 0.0;
    double spread = 0.0;
  } sums_;
};

}  // namespace wiimote_tracker::exposure_clock

#endif
