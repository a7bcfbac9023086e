#include "exposure_clock/clock_estimator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wiimote_tracker::exposure_clock {

namespace {
// Values without a source are not critical: half of each or twice as much changes the RMS error of
// each kind of link, simulated as in benchmark_timing, by at most 5 %.

// Blur of an edge [s]: negligible, or a slot of 1.25 ms (standard deviation 1.25 ms / sqrt(12)).
constexpr double kSharp = 10e-6;
constexpr double kSlotted = 0.36e-3;
// Wander after 1 s [s]: of a good clock (0.01 ms in 10 s), 0.3 ms and 1 ms in 10 s, and 5 ms in
// 10 s, the most of recordings of two remotes (2.5 to 5 ms). Only sharp edges tell 0.3 from 1 ms;
// beside 5 ms a slot is negligible.
constexpr double kSteady = 0.003e-3;
constexpr double kWanders = 0.095e-3;
constexpr double kWandersMuch = 0.32e-3;
constexpr double kWandersAsRecorded = 1.58e-3;

// Of the period, relative, so that a remote may be fast or slow; it stays within three times this.
constexpr double kPeriodStddev = 2500e-6;
// A report later than this, three periods, is stale [s].
constexpr double kStaleAge = 0.030;

struct ModelPrior {
  DelayModel model;
  double prior;  // only the ratios count: weights are normalised at each report
};
constexpr double kPriorSteady = 0.14, kPriorWanders = 0.09, kPriorWandersMuch = 0.10,
                 kPriorWandersAsRecorded = 0.10;
const ModelPrior kModelPriors[] = {
    {{true, kSharp, kSteady}, kPriorSteady},
    {{true, kSharp, kWanders}, kPriorWanders},
    {{true, kSharp, kWandersMuch}, kPriorWandersMuch},
    {{true, kSharp, kWandersAsRecorded}, kPriorWandersAsRecorded},
    {{true, kSlotted, kSteady}, kPriorSteady},
    {{true, kSlotted, kWandersMuch}, kPriorWandersMuch},
    {{false, 0.0, kSteady}, kPriorSteady},
    {{false, 0.0, kWandersMuch}, kPriorWandersMuch},
    {{false, 0.0, kWandersAsRecorded}, kPriorWandersAsRecorded},
};

// Index of the model whose posterior SteadyEdge computes, and its weight when SteadyEdge begins.
constexpr std::size_t kSteadyEdge = 0;
constexpr double kSteadyEdgeWeight = 0.5;
// SteadyEdge and learnStalls() use a report whose smoothed number is this probable.
constexpr double kCertain = 0.9;
// SteadyEdge leaves out a report that is this much too early [s]: its number is wrong.
constexpr double kTooEarly = 1e-3;
// A steady edge of negligible weight that is this far from the best model [s] has wrong numbers.
constexpr double kMaxEdgeError = 0.5e-3;
// Time over which the wander of a steady clock is added to its variance [s].
constexpr double kEdgeMemory = 3.0;

// Initial share of reports that a stall holds up, and the mean time it does [s], as in recordings
// of two remotes; the number of reports they count as; the number of latest reports they are
// estimated from; and the share of this length that is always added.
constexpr double kInitialStallProbability = 0.02;
constexpr double kInitialStallLength = 0.020;
constexpr double kStallPriorCount = 300.0;
constexpr double kStallMemory = 6000.0;
constexpr double kMinStallProbability = 0.0005;
// Mean time between reports that leave a queue [s].
constexpr double kServiceTime = 0.0025;
// Density of an arrival that no model explains [1/s]; a stall explains delays up to 0.3 s.
constexpr double kUnexplained = 1e-7;
// Number of such arrivals in a row after which the clock restarts, as when reports come once a
// second or less.
constexpr int kMaxUnexplained = 8;
// Number of reports in a row, one second, with an uncertain frame after which it restarts, as when
// reports came twice for a while.
constexpr int kMaxUncertain = 100;
// Gap after which the phase is estimated anew [s]; largest ignored step back of the clock [s].
constexpr double kLongGap = 5.0;
constexpr double kStepBack = 1e-3;
// Weight below which a model is reinitialised from the best one. With twice as much the stated
// deviations behind edges are 9 % larger.
constexpr double kMinWeight = 1.5e-4;
// The same of an edge beside a bell: delays of a bell may look like an edge for a second, while
// those of an edge soon contradict a bell. A thousandth of this is as good. During the first
// reports of a link delays of an edge look like a bell, too, until its spread is known.
constexpr double kMinWeightOfEdge = 1e-9;
constexpr double kReportsForSpread = 100.0;
// Probability below which a frame number does not change a filter.
constexpr double kNegligible = 1e-6;
}  // namespace

/// Densities of an arrival [1/s]: the report was on time, or waited for the one before, or was held
/// up by a stall.
struct ClockEstimator::ArrivalDensity {
  double late;  // this report, after the least delay [s]
  double on_time, queued, stalled;
  double sum() const { return on_time + queued + stalled; }
};

/// A report's arrival and the one before [s], and the density of the time between them if it waited
/// for that one on the link [1/s]. `waited`: it arrived at an unknown time before that.
struct ClockEstimator::Arrival {
  double time, before, served;
  bool waited;
};

ClockEstimator::Arrival ClockEstimator::arrivalAfter(double before, double time, bool waited) {
  return {time, before, std::exp(-(time - before) / kServiceTime) / kServiceTime, waited};
}

ClockEstimator::Bank ClockEstimator::makeBank(double period) {
  if (!(period > 0.0))
    throw std::invalid_argument("ExposureClock: the period must be above 0.");
  const auto make = [&](int i) {
    return ClockFilter(kModelPriors[i].model, period, period * kPeriodStddev);
  };
  return {make(0), make(1), make(2), make(3), make(4), make(5), make(6), make(7), make(8)};
}

ClockEstimator::ClockEstimator(double period)
    : period_(period),
      filters_(makeBank(period)),
      edge_(period, 3.0 * period * kPeriodStddev),
      stall_probability_(kInitialStallProbability),
      stall_time_(kInitialStallProbability * kInitialStallLength) {
  static_assert(sizeof(kModelPriors) / sizeof(kModelPriors[0]) == kModels,
                "one filter per candidate");
  std::transform(std::begin(kModelPriors), std::end(kModelPriors), weights_.begin(),
                 [](const ModelPrior& candidate) { return candidate.prior; });
}

void ClockEstimator::copyLinkFrom(const ClockEstimator& other) {
  stall_probability_ = other.stall_probability_;
  stall_time_ = other.stall_time_;
  sample_count_ = other.sample_count_;
  counter_.copyLossesFrom(other.counter_);
}

const ClockFilter& ClockEstimator::best() const {
  return filters_[static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.end()) -
                                           weights_.begin())];
}

Estimate ClockEstimator::update(double arrival, bool waited) {
  if (!std::isfinite(arrival))
    throw std::invalid_argument("ExposureClock: the arrival time is not a finite number.");
  if (!running_) {
    running_ = true;
    origin_ = arrival;
    last_exposure_ = -period_;
    return restart(0.0, 0);
  }
  const double gap = arrival - origin_ - last_arrival_;
  if (gap < -kStepBack || gap > kLongGap) {
    const double periods = gap / best().period();
    Estimate e = restart(arrival - origin_,
                         frame_ + std::max<std::int64_t>(1, std::llround(std::max(0.0, periods))));
    e.restarted = true;
    return e;
  }
  arrival = last_arrival_ + std::max(0.0, gap);
  updateModels(arrival, waited);
  if (unexplained_ >= kMaxUnexplained || uncertain_ >= kMaxUncertain) {
    filters_ = makeBank(period_);
    counter_ = FrameCounter();  // losses that were learned from such reports are wrong
    sample_count_ = 0.0;        // so are the stalls, and the filters know no spread yet
    Estimate e = restart(arrival, frame_ + 1);
    e.restarted = true;
    return e;
  }
  reinitialiseUnlikelyModels();
  return estimate(arrival);
}

Estimate ClockEstimator::restart(double arrival, std::int64_t frame) {
  for (ClockFilter& filter : filters_)
    filter.start(arrival);
  edge_.clear();
  edge_used_ = false;
  counter_.start(frame);
  history_.clear();
  history_.add(counter_, arrival, 0.0);
  Estimate e;
  e.frame = frame;
  frame_ = frame;
  unexplained_ = uncertain_ = 0;
  log_evidence_ = std::log(kUnexplained);
  // Exposures follow a clock that stepped back; otherwise they increase.
  const double exposure =
      arrival < last_arrival_ ? arrival : std::max(arrival, last_exposure_ + kShortestStep);
  last_arrival_ = arrival;
  last_exposure_ = exposure;
  e.exposure = origin_ + exposure;
  e.stddev = e.clock_stddev = period_ + (exposure - arrival);
  return e;
}

ClockEstimator::ArrivalDensity ClockEstimator::arrivalDensity(const ClockFilter& filter,
                                                              const Arrival& arrival,
                                                              double offset) const {
  const ClockFilter::Prediction frame = filter.predict(offset);
  const double stall_rate = stall_probability_ / stall_time_;  // over the mean length [1/s]
  ArrivalDensity density;
  density.late = arrival.time - filter.time() - offset * filter.period();
  // It says only that the frame was ready before; the constant factor cancels.
  if (arrival.waited) {
    density.on_time = density.stalled = 0.0;
    density.queued = filter.readyBefore(frame, arrival.time) / period_;
    return density;
  }
  density.on_time = (1.0 - stall_probability_) * filter.likelihood(frame, arrival.time);
  density.queued = filter.readyBefore(frame, arrival.before) * arrival.served;
  density.stalled = density.late > 0.0
                        ? stall_probability_ * stall_rate * std::exp(-density.late * stall_rate)
                        : 0.0;
  return density;
}

// Bayes' rule for the frame number, the models, and each model's clock.
void ClockEstimator::updateModels(double arrival, bool waited) {
  const Arrival now = arrivalAfter(last_arrival_, arrival, waited);
  const ClockFilter& likeliest = best();
  const double periods = (arrival - likeliest.time()) / likeliest.period();
  counter_.predict(frame_ + 1 + static_cast<std::int64_t>(std::floor(periods)));
  std::array<double, FrameCounter::kCapacity> on_time, number;
  std::fill_n(number.begin(), counter_.size(), 0.0);
  double sum = 0.0, on_steady_edge = 0.0;
  for (std::size_t m = 0; m < kModels; ++m) {
    ClockFilter& filter = filters_[m];
    double evidence = 0.0;
    for (int i = 0; i < counter_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double offset = static_cast<double>(counter_.frame(i) - frame_);
      const ArrivalDensity density = arrivalDensity(filter, now, offset);
      // Only reports that were on time are measurements of the clock.
      on_time[at] = counter_[i] * density.on_time;
      const double all = counter_[i] * (density.sum() + kUnexplained);
      evidence += all;
      number[at] += weights_[m] * all;
    }
    ClockFilter::Hypotheses hypotheses;
    for (int i = 0; i < counter_.size(); ++i) {
      const double probability = on_time[static_cast<std::size_t>(i)] / evidence;
      if (probability > kNegligible)
        filter.addHypothesis(filter.predict(static_cast<double>(counter_.frame(i) - frame_)),
                             arrival, probability, &hypotheses);
      if (m == kSteadyEdge)
        on_steady_edge += probability;
    }
    filter.apply(hypotheses);
    weights_[m] *= evidence;
    sum += weights_[m];
  }
  log_evidence_ = std::log(sum);
  unexplained_ = sum < 10.0 * kUnexplained ? unexplained_ + 1 : 0;
  for (double& weight : weights_)
    weight /= sum;
  for (int i = 0; i < counter_.size(); ++i)
    counter_[i] = number[static_cast<std::size_t>(i)];
  counter_.normalise();
  learnFromHistory(arrival, on_steady_edge);
  applySteadyEdge();
}

/// Uses the smoothed frame numbers, as soon as they are certain. Losses are expectations over all
/// numbers (Baum, Welch): certain reports alone would have too few.
void ClockEstimator::learnFromHistory(double arrival, double on_time) {
  history_.add(counter_, arrival, on_time);
  if (!history_.complete())
    return;
  const ClockFilter& edge = filters_[kSteadyEdge];
  const int reports = history_.smooth(counter_);
  for (int i = 1; i < reports; ++i) {
    const FrameHistory::Report& report = history_.report(i);
    counter_.learn(report.lost, report.kept);
    if (report.probability < kCertain)
      continue;
    const auto offset = static_cast<double>(report.frame - frame_);
    if (report.arrival - edge.time() - offset * edge.period() > -kTooEarly)
      edge_.add(report.frame, report.arrival, report.on_time, edge.period());
    learnStalls(arrivalDensity(best(), arrivalAfter(history_.report(i - 1).arrival, report.arrival),
                               offset));
  }
}

/// A step of expectation maximisation.
void ClockEstimator::learnStalls(const ArrivalDensity& density) {
  sample_count_ = std::min(sample_count_ + 1.0, kStallMemory);
  const double stalled = density.stalled / (density.sum() + kUnexplained);
  const double rate = 1.0 / (sample_count_ + kStallPriorCount);
  stall_probability_ += rate * (stalled + kMinStallProbability - stall_probability_);
  stall_time_ +=
      rate * (stalled * density.late + kMinStallProbability * kInitialStallLength - stall_time_);
}

void ClockEstimator::applySteadyEdge() {
  ClockFilter& filter = filters_[kSteadyEdge];
  if (!edge_.ready())
    return;
  if (!edge_used_) {  // its weight was that of a normal approximation
    edge_used_ = true;
    weights_[kSteadyEdge] = std::max(weights_[kSteadyEdge], kSteadyEdgeWeight);
  }
  ClockState state = edge_.state(frame_, filter.spread());
  state.p00 += kSteady * kSteady * kEdgeMemory;
  filter.setState(state);
}

void ClockEstimator::reinitialiseUnlikelyModels() {
  const ClockFilter& likeliest = best();
  double sum = 0.0;
  for (std::size_t m = 0; m < kModels; ++m) {
    const bool edge_beside_bell = filters_[m].model().hard_edge && !likeliest.model().hard_edge;
    const double least =
        edge_beside_bell && sample_count_ > kReportsForSpread ? kMinWeightOfEdge : kMinWeight;
    if (weights_[m] < least) {
      weights_[m] = least;
      if (m != kSteadyEdge || !edge_.ready())
        filters_[m].copyStateFrom(likeliest);
      else if (std::abs(filters_[m].time() - likeliest.time()) > kMaxEdgeError)
        edge_.clear();
    }
    sum += weights_[m];
  }
  for (double& weight : weights_)
    weight /= sum;
}

Estimate ClockEstimator::estimate(double arrival) {
  const std::int64_t previous = frame_;
  frame_ = counter_.mostProbable();
  double time = 0.0, period = 0.0, variance = 0.0, spread = 0.0;
  for (std::size_t m = 0; m < kModels; ++m) {
    filters_[m].advance(static_cast<double>(frame_ - previous));
    time += weights_[m] * filters_[m].time();
    period += weights_[m] * filters_[m].period();
    spread += weights_[m] * filters_[m].spread();
  }
  for (std::size_t m = 0; m < kModels; ++m)
    variance += weights_[m] * (filters_[m].timeVariance() + std::pow(filters_[m].time() - time, 2));
  // If delays taken for a bell have a sharp edge, the exposures are off by so much.
  if (sample_count_ < kReportsForSpread)
    variance += (1.0 - statistics().hard_edge) * std::pow(kTypicalBellSpread, 2);

  // With the constant part of its delay it may be a little after its arrival; exposures increase.
  const double exposure = std::max(std::min(time, arrival + std::min(3.0 * spread, period)),
                                   last_exposure_ + kShortestStep);
  double number_variance = 0.0;
  for (int i = 0; i < counter_.size(); ++i)
    number_variance +=
        counter_[i] *
        std::pow(time + static_cast<double>(counter_.frame(i) - frame_) * period - exposure, 2);

  Estimate e;
  e.exposure = origin_ + exposure;
  e.clock_stddev = std::sqrt(variance);
  e.stddev = std::sqrt(variance + number_variance);
  uncertain_ = e.stddev > period_ ? uncertain_ + 1 : 0;
  e.frame = frame_;
  e.stale = arrival - time > kStaleAge;
  last_arrival_ = arrival;
  last_exposure_ = exposure;
  return e;
}

Statistics ClockEstimator::statistics() const {
  Statistics s;
  s.period = best().period();
  s.period_stddev = std::sqrt(best().periodVariance());
  for (std::size_t m = 0; m < kModels; ++m) {
    s.jitter += weights_[m] * filters_[m].spread();
    s.hard_edge += filters_[m].model().hard_edge ? weights_[m] : 0.0;
  }
  return s;
}

}  // namespace wiimote_tracker::exposure_clock
