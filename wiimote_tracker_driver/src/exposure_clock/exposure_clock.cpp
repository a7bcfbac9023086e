#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kSecond = 1.0;
// sd of the random walk after 1 s
const std::array<DelayModel, ExposureClock::kModels> kModelBank{{{1.0, 10e-6, 0.003e-3},
{1.0, 10e-6, 0.095e-3},
{1.0, 10e-6, 0.32e-3},
{1.0, 0.36e-3, 0.003e-3},
{1.0, 0.36e-3, 0.095e-3},
{1.0, 0.36e-3, 0.32e-3},
                                                                {0.0,0, 0.003e-3},
                                                                {0.0,0, 0.095e-3},
                                                                {0.0,0, 0.32e-3}}};
const std::array<double,ExposureClock::kModels> kPrior{.17,.1,.07,.17,.1,.07,.17,.1,.07};
constexpr double kStall = 0.003;
constexpr double kStallLength = 0.060;
constexpr double kServiceTime = 0.0025;
constexpr double kOdd = 1e-7;         // density [1/s] * probability of an arrival that nothing explains
constexpr double kForget = 0.9995;
constexpr double kLeastWeight = 1e-4;
}  // namespace

ExposureClock::ExposureClock(const ExposureClockOptions& options)
    : options_(options),
      filters_{{ClockFilter(kModelBank[0], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[1], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[2], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[3], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[4], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[5], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[6], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[7], options.period, options.period * options.period_stddev),
ClockFilter(kModelBank[8], options.period, options.period * options.period_stddev)}} {
  weight_=kPrior;
}

void ExposureClock::reset() {
  *this = ExposureClock(options_);
}

void ExposureClock::start(double arrival) {
  origin_ = arrival;
  for (ClockFilter& f : filters_)
    f.start(0.0);
  base_ = last_frame_ + 1;
  counter_.start(base_);
  running_ = true;
}

Estimate ExposureClock::update(double arrival_s) {
  Estimate e;
  ++statistics_.reports;
  if (!running_) {
    start(arrival_s);
    e.exposure = arrival_s;
    e.stddev = e.clock_stddev = 0.005;
    e.frame = base_;
    last_frame_ = base_;
    last_arrival_ = 0.0;
    last_exposure_ = 0.0;
    return e;
  }
  const double arrival = std::max(arrival_s - origin_, last_arrival_);
  // Numbers that come into question.
  int best = 0;
  for (int m = 1; m < kModels; ++m)
    if (weight_[m] > weight_[best])
      best = m;
  const double period = filters_[best].period();
  const auto newest = base_ + static_cast<std::int64_t>(
                                  std::floor((arrival - filters_[best].time()) / period + 1.0));
  counter_.predict(newest);
  const int n = counter_.size();

  // Likelihoods, per model and number.
  std::array<std::array<double, FrameCounter::kCapacity>, kModels> informative;
  std::array<double, FrameCounter::kCapacity> total{};
  std::array<double, kModels> evidence{};
  const double gap = arrival - last_arrival_;
  const double service = std::exp(-gap / kServiceTime) / kServiceTime;
  for (int m = 0; m < kModels; ++m) {
    const ClockFilter& f = filters_[m];
    for (int i = 0; i < n; ++i) {
      const double prior = counter_[i];
      if (prior < 1e-12) {
        informative[m][i] = 0.0;
        continue;
      }
      const double offset = static_cast<double>(counter_.first() + i - base_);
      const double late = arrival - f.time() - offset * f.period();
      const double on_time = (1.0 - kStall) * f.likelihood(arrival, offset);
      const double queued = f.readyBefore(last_arrival_, offset) * service;
      const double stalled = late > 0.0 ? kStall / kStallLength * std::exp(-late / kStallLength) : 0.0;
      const double all = prior * (on_time + queued + stalled + kOdd);
      informative[m][i] = prior * on_time;
      evidence[m] += all;
      total[i] += weight_[m] * all;
    }
  }
  for (int i = 0; i < n; ++i)
    counter_[i] = total[i];
  const std::int64_t first = counter_.first();
  for (int m = 0; m < kModels; ++m) {
    for (int i = 0; i < n; ++i) {
      const double w = informative[m][i] / evidence[m];
      if (w > 1e-6)
        filters_[m].consider(arrival, static_cast<double>(first + i - base_), w);
    }
    filters_[m].settle();
  }
  double sum = 0.0;
  for (int m = 0; m < kModels; ++m) {
    weight_[m] = std::pow(weight_[m], kForget) * evidence[m];
    sum += weight_[m];
  }
  for (double& w : weight_)
    w /= sum;
  best = static_cast<int>(std::max_element(weight_.begin(), weight_.end()) - weight_.begin());
  for (int m = 0; m < kModels; ++m) {
    if (weight_[m] < kLeastWeight) {
      weight_[m] = kLeastWeight * 1.5;
      filters_[m].follow(filters_[best]);
    }
  }
  sum = 0.0;
  for (double w : weight_)
    sum += w;
  for (double& w : weight_)
    w /= sum;
  counter_.normalise();

  // Most probable number
  int map = 0;
  for (int i = 1; i < counter_.size(); ++i)
    if (counter_[i] > counter_[map])
      map = i;
  std::int64_t frame = counter_.first() + map;
  for (ClockFilter& f : filters_)
    f.advance(static_cast<double>(frame - base_));
  base_ = frame;

  double mean = 0.0, square = 0.0, p = 0.0;
  for (int m = 0; m < kModels; ++m) {
    mean += weight_[m] * filters_[m].time();
    p += weight_[m] * filters_[m].period();
  }
  for (int m = 0; m < kModels; ++m) {
    const double d = filters_[m].time() - mean;
    square += weight_[m] * (filters_[m].variance() + d * d);
  }
  double doubt = 0.0;
  e.frame = frame;
  const double exposure = std::max(mean, last_exposure_ + 1e-6);
  for (int i = 0; i < counter_.size(); ++i) {
    const double d = mean - exposure + static_cast<double>(counter_.first() + i - e.frame) * p;
    doubt += counter_[i] * d * d;
  }
  e.exposure = origin_ + exposure;
  e.clock_stddev = std::sqrt(square);
  e.stddev = std::sqrt(square + doubt);
  e.dropped = static_cast<int>(std::max<std::int64_t>(0, e.frame - last_frame_ - 1));
  e.stale = arrival - exposure > options_.stale_age;
  last_frame_ = e.frame;
  last_arrival_ = arrival;
  last_exposure_ = exposure;
  statistics_.dropped += e.dropped;
  statistics_.stale += e.stale;
  return e;
}

Statistics ExposureClock::statistics() const {
  return statistics_;
}

}  // namespace wiimote_tracker::exposure_clock
