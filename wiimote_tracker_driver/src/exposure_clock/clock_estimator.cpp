#include "exposure_clock/clock_estimator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wiimote_tracker::exposure_clock {

namespace {
// A report later than this, three periods, is stale [s].
constexpr double kStaleAge = 0.030;
// The models learn from a report whose smoothed number is this probable.
constexpr double kCertain = 0.9;
// Number of reports in a row, one second, with an uncertain frame after which the clock restarts,
// as when reports came twice for a while.
constexpr int kMaxUncertain = 100;
// Gap after which the phase is estimated anew [s]; largest ignored step back of the clock [s].
constexpr double kLongGap = 5.0;
constexpr double kStepBack = 1e-3;
}  // namespace

ClockEstimator::ClockEstimator(double period) : period_(period), filters_(period) {
  if (!(period > 0.0))
    throw std::invalid_argument("ExposureClock: the period must be above 0.");
}

void ClockEstimator::copyLinkFrom(const ClockEstimator& other) {
  filters_.copyReportsFrom(other.filters_);
  stalls_ = other.stalls_;
  counter_.copyLossesFrom(other.counter_);
}

Estimate ClockEstimator::update(double arrival, bool waited) {
  if (!std::isfinite(arrival))
    throw std::invalid_argument("ExposureClock: the arrival time is not a finite number.");
  if (!running_) {
    running_ = true;
    origin_ = arrival;
    return restart(0.0, 0);
  }
  const double gap = arrival - origin_ - last_arrival_;
  // A report that waited has no arrival to start from.
  if (gap < -kStepBack || (gap > kLongGap && !waited)) {
    const double periods = std::max(1.0, gap / filters_.best().period());
    Estimate e = restart(arrival - origin_, frame_ + std::llround(periods));
    e.restarted = true;
    return e;
  }
  const StallModel::Arrival now{last_arrival_ + std::max(0.0, gap), last_arrival_, waited};
  const ClockFilter& likeliest = filters_.best();
  const double periods = (now.time - likeliest.time()) / likeliest.period();
  counter_.predict(frame_ + 1 + static_cast<std::int64_t>(std::floor(periods)));
  log_evidence_ = std::log(filters_.update(now, stalls_, &counter_));
  history_.add(counter_, now.time, waited);
  learnFromHistory();
  if (!waited && uncertain_ >= kMaxUncertain) {
    // What was learnt from such reports is wrong.
    filters_ = FilterBank(period_);
    stalls_ = StallModel();
    counter_ = FrameCounter();
    Estimate e = restart(now.time, frame_ + 1);
    e.restarted = true;
    return e;
  }
  return estimate(now.time);
}

Estimate ClockEstimator::restart(double arrival, std::int64_t frame) {
  filters_.start(frame, arrival);
  counter_.start(frame);
  history_.clear();
  history_.add(counter_, arrival);
  frame_ = frame;
  uncertain_ = 0;
  log_evidence_ = std::log(StallModel::kUnexplained);
  last_arrival_ = arrival;
  Estimate e;
  e.exposure = origin_ + arrival;
  e.stddev = e.clock_stddev = period_;
  e.frame = frame;
  return e;
}

/// Uses the smoothed frame numbers, as soon as they are certain. Losses are expectations over all
/// numbers (Baum, Welch): certain reports alone would have too few.
void ClockEstimator::learnFromHistory() {
  if (!history_.complete())
    return;
  const int reports = history_.smooth(counter_);
  for (int i = 1; i < reports; ++i) {
    const FrameHistory::Report& report = history_.report(i);
    counter_.learn(report.lost, report.kept);
    if (report.waited || report.probability < kCertain)
      continue;
    const StallModel::Density density = stalls_.density(
        filters_.best(), report.frame, {report.arrival, history_.report(i - 1).arrival, false});
    filters_.learn(report.frame, report.arrival, density.on_time / density.sum());
    stalls_.learn(density);
  }
}

Estimate ClockEstimator::estimate(double arrival) {
  frame_ = counter_.mostProbable();
  filters_.advanceTo(frame_);
  const FilterBank::Mean mean = filters_.mean();
  // With the constant part of its delay it may be a little after its arrival.
  const double exposure = std::min(mean.time, arrival + std::min(3.0 * mean.spread, mean.period));
  double number_variance = 0.0;
  for (int i = 0; i < counter_.size(); ++i) {
    const double frames = static_cast<double>(counter_.frame(i) - frame_);
    number_variance += counter_[i] * std::pow(mean.time + frames * mean.period - exposure, 2);
  }
  last_arrival_ = arrival;
  Estimate e;
  e.exposure = origin_ + exposure;
  e.clock_stddev = std::sqrt(mean.variance);
  e.stddev = std::sqrt(mean.variance + number_variance);
  e.frame = frame_;
  e.stale = arrival - mean.time > kStaleAge;
  uncertain_ = e.stddev > period_ ? uncertain_ + 1 : 0;
  return e;
}

Statistics ClockEstimator::statistics() const {
  Statistics s;
  s.period = filters_.best().period();
  s.period_stddev = std::sqrt(filters_.best().periodVariance());
  s.jitter = filters_.mean().spread;
  s.exponential = filters_.exponentialProbability();
  return s;
}

}  // namespace wiimote_tracker::exposure_clock
