#include "wiimote_tracker_driver/exposure_clock/clock_filter.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
// Before anything is known [s].
constexpr double kFirstSpread = 0.003;
constexpr double kLeastSpread = 20e-6;
// Normal part of the narrowest edge: what time-stamping itself adds [s].
constexpr double kStampNoise = 10e-6;
// The first spread counts as much as this many reports; the estimate remembers this many.
constexpr double kSpreadPrior = 10.0;
constexpr double kSpreadMemory = 1000.0;

constexpr double kInvSqrt2 = 0.70710678118654752;
constexpr double kInvSqrt2Pi = 0.39894228040143268;

double normalCdf(double x) {
  return 0.5 * std::erfc(-x * kInvSqrt2);
}
// Density over distribution function of the standard normal, also far out where both vanish
// (continued fraction; Abramowitz and Stegun 26.2.14).
double hazard(double x) {
  if (x > -6.0)
    return kInvSqrt2Pi * std::exp(-0.5 * x * x) / normalCdf(x);
  const double y = -x;
  return y + 1.0 / (y + 2.0 / (y + 3.0 / (y + 4.0 / y)));
}
}  // namespace

ClockFilter::ClockFilter(const DelayModel& model, double period, double period_stddev)
    : model_(model), period_(period), p11_(period_stddev * period_stddev), spread_(kFirstSpread) {}

void ClockFilter::start(double time) {
  time_ = time - model_.tail * spread_;
  p00_ = period_ * period_;
  p01_ = 0.0;
}

void ClockFilter::advance(double frames) {
  time_ += frames * period_;
  p00_ += frames * (2.0 * p01_ + frames * p11_) + model_.wander * model_.wander * period_ * frames;
  p01_ += frames * p11_;
}

ClockFilter::Prediction ClockFilter::predict(double offset) const {
  const double normal = spread_ * spread_ * (1.0 - model_.tail * model_.tail) + model_.blur*model_.blur;
  Prediction p;
  p.mean = time_ + offset * period_;
  const double c0 = p00_ + offset * p01_;
  const double c1 = p01_ + offset * p11_;
  p.variance = c0 + offset * c1 + normal;
  p.gain0 = c0 / p.variance;
  p.gain1 = c1 / p.variance;
  return p;
}

double ClockFilter::likelihood(double arrival, double offset) const {
  const Prediction p = predict(offset);
  const double late = arrival - p.mean;
  const double sd = std::sqrt(p.variance);
  const double mu = model_.tail * spread_;
  if (mu < 0.05 * sd)
    return kInvSqrt2Pi / sd * std::exp(-0.5 * late * late / p.variance);
  const double b = (late - p.variance / mu) / sd;
  if (b < -6.0)  // exp(..) * Phi(b) by the density at `late`, to avoid overflow
    return kInvSqrt2Pi * std::exp(-0.5 * late * late / p.variance) / (hazard(b) * mu);
  return std::exp(0.5 * p.variance / (mu * mu) - late / mu) * normalCdf(b) / mu;
}

double ClockFilter::readyBefore(double time, double offset) const {
  const Prediction p = predict(offset);
  const double late = time - p.mean;
  const double sd = std::sqrt(p.variance);
  const double mu = model_.tail * spread_;
  const double normal = normalCdf(late / sd);
  if (mu < 0.05 * sd)
    return normal;
  return std::max(0.0, normal - mu * likelihood(time, offset));
}

void ClockFilter::consider(double arrival, double offset, double weight) {
  const Prediction p = predict(offset);
  const double sd = std::sqrt(p.variance);
  const double mu = model_.tail * spread_;
  double innovation = arrival - p.mean;
  double left = 0.0;  // variance that the arrival leaves to exposure + edge + n
  if (mu >= 0.05 * sd) {
    const double b = (arrival - p.mean - p.variance / mu) / sd;
    const double lambda = hazard(b);
    innovation = p.variance / mu - sd * lambda;
    left = p.variance * std::max(1e-6, 1.0 - lambda * (b + lambda));
  }
  const double s0 = p.gain0 * innovation, s1 = p.gain1 * innovation;
  const double shrink = p.variance - left;
  shift0_ += weight * s0;
  shift1_ += weight * s1;
  d00_ += weight * (s0 * s0 - p.gain0 * p.gain0 * shrink);
  d01_ += weight * (s0 * s1 - p.gain0 * p.gain1 * shrink);
  d11_ += weight * (s1 * s1 - p.gain1 * p.gain1 * shrink);

  // Expected size of this delay beyond the edge (or the mean), for the spread.
  if (model_.tail > 0.0) {
    spread_sum_ += weight * (arrival - p.mean - innovation) / model_.tail;
  } else {
    const double rest = innovation * (1.0 - (p.gain0 + offset * p.gain1));
    const double var = (p.variance - spread_ * spread_) * (spread_ * spread_ / p.variance);
    spread_sum_ += weight * (rest * rest + std::max(0.0, var));
  }
  spread_weight_ += weight;
}

void ClockFilter::settle() {
  time_ += shift0_;
  period_ += shift1_;
  p00_ += d00_ - shift0_ * shift0_;
  p01_ += d01_ - shift0_ * shift1_;
  p11_ += d11_ - shift1_ * shift1_;
  shift0_ = shift1_ = d00_ = d01_ = d11_ = 0.0;

  experience_ = std::min(experience_ + spread_weight_, kSpreadMemory);
  const double rate = 1.0 / (kSpreadPrior + experience_);
  if (model_.tail > 0.0)
    spread_ += rate * (spread_sum_ - spread_weight_ * spread_);
  else
    spread_ = std::sqrt(spread_ * spread_ + rate * (spread_sum_ - spread_weight_ * spread_ * spread_));
  spread_ = std::max(spread_, kLeastSpread);
  spread_sum_ = spread_weight_ = 0.0;
}

void ClockFilter::follow(const ClockFilter& other) {
  const DelayModel mine = model_;
  *this = other;
  model_ = mine;
  time_ += (1.0 - mine.tail) * spread_ - (1.0 - other.model_.tail) * spread_;
}

}  // namespace wiimote_tracker::exposure_clock
