#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_CLOCK_FILTER_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_CLOCK_FILTER_H

namespace wiimote_tracker::exposure_clock {

/// One belief about how reports are delayed: what a ClockFilter assumes.
struct DelayModel {
  /// Share of the delay's standard deviation that is exponential, 0..1: 1 is an exponential behind a
  /// hard edge, 0 a bell. The rest is normal: tail^2 + (normal part)^2 = 1.
  double tail = 1.0;
  double blur = 0.0;
  /// Random walk of the camera's phase: standard deviation after one second [s].
  double wander = 0.0;
};

/// Phase and period of a periodic camera as a Gaussian belief, for one delay model.
///
/// Arrival = exposure + edge + e + n, with e exponential of mean tail * spread and n normal with the
/// rest of the spread. An arrival makes the belief of (exposure + edge + n) a normal that is tilted by
/// the exponential and cut at the arrival; its first two moments are kept (assumed density
/// filtering; Maybeck, Stochastic Models, Estimation and Control 2, 1982, ch. 12.7). With tail 0
/// this is the Kalman filter; with tail 1 it follows the lower edge of the arrivals.
class ClockFilter {
 public:
  /// @param period nominal period [s], with standard deviation period_stddev [s].
  ClockFilter(const DelayModel& model, double period, double period_stddev);

  /// Starts at a frame that arrived at `time` [s]; forgets the phase; keeps period and spread.
  void start(double time);
  /// Moves the belief `frames` periods on.
  void advance(double frames);

  /// Exposure time of the frame that the belief stands at [s], apart from the least delay. The same point
  /// of the delay's distribution for all models: mean - spread, which is the edge of an exponential.
  double time() const { return time_ - (1.0 - model_.tail) * spread_; }
  double variance() const { return p00_; }
  double period() const { return period_; }
  double spread() const { return spread_; }

  struct Gain;
  /// Density [1/s] of an arrival at `arrival` of the frame `offset` frames after the belief's.
  double likelihood(double arrival, double offset) const;
  /// Probability that this frame was ready before `time`.
  double readyBefore(double time, double offset) const;

  /// Weighs in the possibility, of probability `weight`, that `arrival` belongs to the frame
  /// `offset` frames after the belief's. All possibilities of one arrival, then settle().
  void consider(double arrival, double offset, double weight);
  void settle();

  /// Takes phase and period over from a filter that does better.
  void follow(const ClockFilter& other);

 private:
  struct Prediction {
    double mean, variance;  // of exposure + edge + n
    double gain0, gain1;
  };
  Prediction predict(double offset) const;

  DelayModel model_;
  double time_ = 0.0;
  double period_;
  double p00_ = 0.0, p01_ = 0.0, p11_;
  double spread_;
  // Sums over the possibilities of one arrival.
  double shift0_ = 0.0, shift1_ = 0.0, d00_ = 0.0, d01_ = 0.0, d11_ = 0.0;
  double spread_sum_ = 0.0, spread_weight_ = 0.0, experience_ = 0.0;
};

}  // namespace wiimote_tracker::exposure_clock

#endif
