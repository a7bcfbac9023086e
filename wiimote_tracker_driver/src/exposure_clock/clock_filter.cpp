#include "exposure_clock/clock_filter.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
// Initial spread [s], and the number of reports it counts as. An exponential starts wider and
// adapts more slowly, because a spread too small moves the least delay past the arrivals.
constexpr double kFirstExponentialSpread = 0.005;
constexpr double kFirstNormalSpread = 0.003;
constexpr double kExponentialPrior = 30.0;
constexpr double kNormalPrior = 5.0;
constexpr double kMinSpread = 20e-6;
constexpr double kSpreadMemory = 1000.0;  // reports
// An arrival before the least delay keeps at least this share of the variance: the posterior is not
// exactly normal, and one outlier must not make it certain.
constexpr double kMinVarianceRatio = 0.5;
// Exponentials of smaller mean, relative to the uncertainty, are negligible. With them, the filter
// would be far too certain after a gap on a link of little jitter.
constexpr double kMinRelativeSpread = 0.05;
// Time over which the wander of a steady clock is added to its variance [s].
constexpr double kExactMemory = 3.0;

// Standard deviations below the mean that have no probability.
constexpr double kImpossible = -6.0;
constexpr double kInvSqrt2 = 0.70710678118654752;
constexpr double kInvSqrt2Pi = 0.39894228040143268;

double square(double x) {
  return x * x;
}
double normalDensity(double x) {
  return kInvSqrt2Pi * std::exp(-0.5 * x * x);
}
double normalCdf(double x) {
  return 0.5 * std::erfc(-x * kInvSqrt2);
}
// normalDensity / normalCdf, also where both underflow (Abramowitz, Stegun, eq. 26.2.14).
double inverseMills(double x) {
  if (x > -6.0)
    return normalDensity(x) / normalCdf(x);
  return -x + 1.0 / (-x + 2.0 / (-x + 3.0 / (-x + 4.0 / -x)));
}
}  // namespace

ClockFilter::ClockFilter(const DelayModel& model, double period, double period_stddev)
    : model_(model),
      nominal_period_(period),
      period_tolerance_(3.0 * period_stddev),
      state_{0.0, period, 0.0, 0.0, square(period_stddev)},
      spread_(model.exponential ? kFirstExponentialSpread : kFirstNormalSpread) {
  if (model.exact)
    posterior_.emplace(period, period_tolerance_);
}

void ClockFilter::start(std::int64_t frame, double arrival) {
  frame_ = frame;
  state_.time = model_.exponential ? arrival - spread_ : arrival;
  state_.p00 = square(state_.period);
  state_.p01 = 0.0;
  if (posterior_)
    posterior_->clear();
}

void ClockFilter::advanceTo(std::int64_t frame) {
  const auto frames = static_cast<double>(frame - frame_);
  frame_ = frame;
  if (exact()) {
    state_ = posterior_->state(frame, spread_);
    state_.p00 += square(model_.wander) * kExactMemory;
    return;
  }
  state_.time += frames * state_.period;
  state_.p00 += frames * (2.0 * state_.p01 + frames * state_.p11) +
                square(model_.wander) * std::max(0.0, frames) * state_.period;
  state_.p01 += frames * state_.p11;
}

double ClockFilter::time() const {
  return model_.exponential ? state_.time : state_.time - kTypicalNormalSpread;
}

ClockFilter::Prediction ClockFilter::predict(std::int64_t frame) const {
  const auto offset = static_cast<double>(frame - frame_);
  // Covariances of z with the state's time and period.
  const double c0 = state_.p00 + offset * state_.p01;
  const double c1 = state_.p01 + offset * state_.p11;
  Prediction z;
  z.mean = state_.time + offset * state_.period;
  z.exposure = z.mean - (model_.exponential ? 0.0 : kTypicalNormalSpread);
  z.variance = c0 + offset * c1 + square(model_.exponential ? model_.blur : spread_);
  z.stddev = std::sqrt(z.variance);
  z.time_gain = c0 / z.variance;
  z.period_gain = c1 / z.variance;
  return z;
}

bool ClockFilter::hasExponential(const Prediction& z) const {
  return model_.exponential && spread_ > kMinRelativeSpread * z.stddev;
}

double ClockFilter::likelihood(const Prediction& z, double arrival) const {
  const double late = arrival - z.mean;
  if (!hasExponential(z))
    return normalDensity(late / z.stddev) / z.stddev;
  // Exponentially modified Gaussian; the second form is equal and does not over- or underflow.
  const double b = late / z.stddev - z.stddev / spread_;
  if (b > -6.0)
    return std::exp(0.5 * z.variance / square(spread_) - late / spread_) * normalCdf(b) / spread_;
  return normalDensity(late / z.stddev) / (inverseMills(b) * spread_);
}

double ClockFilter::readyBefore(const Prediction& z, double time) const {
  const double early = (time - z.mean) / z.stddev;
  if (early < kImpossible)
    return 0.0;
  const double normal = normalCdf(early);
  return hasExponential(z) ? std::max(0.0, normal - spread_ * likelihood(z, time)) : normal;
}

void ClockFilter::addHypothesis(const Prediction& z,
                                double arrival,
                                double weight,
                                Hypotheses* sums) const {
  double innovation = arrival - z.mean;
  double variance = 0.0;  // of z, given the arrival
  if (hasExponential(z)) {
    // A normal of mean z.mean + z.variance / spread_, truncated above at the arrival.
    const double b = innovation / z.stddev - z.stddev / spread_;
    const double mills = inverseMills(b);
    innovation = z.variance / spread_ - z.stddev * mills;
    variance = z.variance * std::max(kMinVarianceRatio, 1.0 - mills * (b + mills));
  }
  const double time_shift = z.time_gain * innovation;
  const double period_shift = z.period_gain * innovation;
  const double reduction = z.variance - variance;
  sums->weight += weight;
  sums->time += weight * time_shift;
  sums->period += weight * period_shift;
  sums->p00 += weight * (square(time_shift) - square(z.time_gain) * reduction);
  sums->p01 += weight * (time_shift * period_shift - z.time_gain * z.period_gain * reduction);
  sums->p11 += weight * (square(period_shift) - square(z.period_gain) * reduction);

  // Expectation maximisation of the spread, given the new state.
  if (model_.exponential) {
    sums->spread += weight * (arrival - z.mean - innovation);
  } else {
    const double share = square(spread_) / z.variance;
    sums->spread += weight * (square(innovation * share) + (z.variance - square(spread_)) * share);
  }
}

void ClockFilter::apply(const Hypotheses& sums) {
  state_.time += sums.time;
  state_.period += sums.period;
  state_.p00 += sums.p00 - square(sums.time);
  state_.p01 += sums.p01 - sums.time * sums.period;
  state_.p11 += sums.p11 - square(sums.period);
  // A period beyond the tolerance would hide wrong frame numbers.
  const double excess =
      state_.period - std::min(std::max(state_.period, nominal_period_ - period_tolerance_),
                               nominal_period_ + period_tolerance_);
  if (excess != 0.0) {
    state_.time -= state_.p01 / state_.p11 * excess;
    state_.period -= excess;
  }
  learnSpread(sums);
}

void ClockFilter::learnSpread(const Hypotheses& sums) {
  reports_ = std::min(reports_ + sums.weight, kSpreadMemory);
  const double rate = 1.0 / (reports_ + (model_.exponential ? kExponentialPrior : kNormalPrior));
  if (model_.exponential)
    spread_ += rate * (sums.spread - sums.weight * spread_);
  else
    spread_ = std::sqrt(square(spread_) + rate * (sums.spread - sums.weight * square(spread_)));
  spread_ = std::max(spread_, kMinSpread);
}

void ClockFilter::learn(std::int64_t frame, double arrival, double on_time) {
  if (posterior_)
    posterior_->add(frame, arrival, on_time, state_.period);
}

void ClockFilter::follow(const ClockFilter& better) {
  if (posterior_)
    posterior_->clear();
  state_ = better.state_;
  spread_ = better.spread_;
  reports_ = better.reports_;
  if (model_.exponential && !better.model_.exponential)
    state_.time -= spread_;
  if (!model_.exponential && better.model_.exponential)
    state_.time += spread_;
}

}  // namespace wiimote_tracker::exposure_clock
