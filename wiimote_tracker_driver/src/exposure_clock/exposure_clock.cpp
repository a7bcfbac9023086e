#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wiimote_tracker::exposure_clock {

namespace {
// Blur of an edge: none to speak of, or a slot of 1.25 ms (its standard deviation, 1.25 ms /
// sqrt(12)).
constexpr double kSharp = 10e-6;
constexpr double kSlotted = 0.36e-3;
// Wander after 1 s: of a good clock (0.01 ms in 10 s), 0.3 ms and 1 ms in 10 s.
constexpr double kSteady = 0.003e-3;
constexpr double kWanders = 0.095e-3;
constexpr double kWandersMuch = 0.32e-3;

struct Candidate {
  DelayModel model;
  double prior;
};
constexpr double kPriorSteady = 0.14, kPriorWanders = 0.09, kPriorWandersMuch = 0.10;
const Candidate kCandidates[] = {
    {{true, kSharp, kSteady}, kPriorSteady},
    {{true, kSharp, kWanders}, kPriorWanders},
    {{true, kSharp, kWandersMuch}, kPriorWandersMuch},
    {{true, kSlotted, kSteady}, kPriorSteady},
    {{true, kSlotted, kWanders}, kPriorWanders},
    {{true, kSlotted, kWandersMuch}, kPriorWandersMuch},
    {{false, 0.0, kSteady}, kPriorSteady},
    {{false, 0.0, kWanders}, kPriorWanders},
    {{false, 0.0, kWandersMuch}, kPriorWandersMuch},
};

// The first candidate: its belief is not normal, and computed exactly by SteadyEdge; and its weight
// when that takes over.
constexpr std::size_t kSteadyEdge = 0;
constexpr double kPriorSteadyEdge = 0.5;
// SteadyEdge takes a report whose number is this probable in hindsight, and that is not this much
// too early [s], which would mean a wrong number all the same.
constexpr double kSure = 0.9;
constexpr double kTooEarly = 1e-3;
// A steady edge that explains nothing and is this far from the best model began with wrong
// numbers [s].
constexpr double kContradiction = 0.5e-3;
// Time over which even a steady clock's wander counts [s].
constexpr double kEdgeMemory = 3.0;

// A report may be held up, for this long on average [s]; probability before anything is known, how
// many reports that counts as, from how many of the last it is learnt, and its least value.
constexpr double kStallLength = 0.060;
constexpr double kFirstStalls = 0.003;
constexpr double kStallPrior = 300.0;
constexpr double kStallMemory = 6000.0;
constexpr double kFewestStalls = 0.0005;
// Behind delays that spread wider than this, in periods, a late report and a lost one look alike:
// nothing is learnt of losses.
constexpr double kTellable = 0.6;
// Mean time between reports that leave a queue [s].
constexpr double kServiceTime = 0.0025;
// Density of an arrival that nothing explains [1/s].
constexpr double kUnexplained = 1e-7;
// After so many of them in a row the clock is lost.
constexpr int kLost = 8;
// And after so many in a row, a second, that may be of many frames: it explains them, but badly.
constexpr int kDoubtful = 100;
// A gap after which the phase is learnt anew [s]; how far a clock may step back unnoticed [s].
constexpr double kLongGap = 5.0;
constexpr double kStepBack = 1e-3;
// A model with less weight than this starts again from the best one.
constexpr double kLeastWeight = 1.5e-4;
constexpr double kNegligible = 1e-6;
// Least time between two exposures: where a frame number was corrected backwards [s].
constexpr double kLeastStep = 1e-6;

double square(double x) {
  return x * x;
}
}  // namespace

/// Densities of an arrival [1/s] by how the report came: when it was ready, or it was ready earlier
/// and waited for the one before, or it was held up.
struct ExposureClock::Ways {
  double on_time, queued, held_up;
  double sum() const { return on_time + queued + held_up; }
};

ExposureClock::Bank ExposureClock::makeBank(const ExposureClockOptions& options) {
  if (!(options.period > 0.0 && options.period_stddev > 0.0 && options.stale_age > 0.0))
    throw std::invalid_argument(
        "ExposureClockOptions: period, period_stddev and stale_age must be above 0.");
  const auto make = [&](int i) {
    return ClockFilter(kCandidates[i].model, options.period,
                       options.period * options.period_stddev);
  };
  return {make(0), make(1), make(2), make(3), make(4), make(5), make(6), make(7), make(8)};
}

ExposureClock::ExposureClock(const ExposureClockOptions& options)
    : options_(options),
      filters_(makeBank(options)),
      edge_(options.period, 3.0 * options.period * options.period_stddev),
      stalls_(kFirstStalls) {
  static_assert(sizeof(kCandidates) / sizeof(kCandidates[0]) == kModels,
                "one filter per candidate");
  std::transform(std::begin(kCandidates), std::end(kCandidates), weights_.begin(),
                 [](const Candidate& candidate) { return candidate.prior; });
}

void ExposureClock::reset() {
  *this = ExposureClock(options_);
}

const ClockFilter& ExposureClock::best() const {
  return filters_[static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.end()) -
                                           weights_.begin())];
}

Estimate ExposureClock::update(double arrival) {
  if (!std::isfinite(arrival))
    throw std::invalid_argument("ExposureClock: the arrival time is not a finite number.");
  ++statistics_.reports;
  if (!running_) {
    running_ = true;
    origin_ = arrival;
    last_exposure_ = -options_.period;
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
  weigh(arrival);
  if (unexplained_ >= kLost || doubtful_ >= kDoubtful) {
    filters_ = makeBank(options_);
    Estimate e = restart(arrival, frame_ + 1);
    e.restarted = true;
    return e;
  }
  reviveLosers();
  return estimate(arrival);
}

Estimate ExposureClock::restart(double arrival, std::int64_t frame) {
  for (ClockFilter& filter : filters_)
    filter.start(arrival);
  history_.clear();
  edge_.clear();
  edge_joined_ = false;
  settled_arrival_ = arrival;
  settled_frame_ = frame;
  counter_.start(frame);
  Estimate e;
  e.frame = frame;
  if (statistics_.reports > 1) {
    ++statistics_.restarts;
    e.dropped = static_cast<int>(std::min<std::int64_t>(frame - frame_ - 1, 1000000));
    statistics_.dropped += e.dropped;
  }
  frame_ = frame;
  unexplained_ = doubtful_ = 0;
  // A clock that stepped back takes the exposures with it; otherwise they go on.
  const double exposure =
      arrival < last_arrival_ ? arrival : std::max(arrival, last_exposure_ + kLeastStep);
  last_arrival_ = arrival;
  last_exposure_ = exposure;
  e.exposure = origin_ + exposure;
  e.stddev = e.clock_stddev = options_.period + (exposure - arrival);
  return e;
}

ExposureClock::Ways ExposureClock::waysOf(const ClockFilter& filter,
                                          double arrival,
                                          double arrival_before,
                                          double offset) const {
  const double late = arrival - filter.time() - offset * filter.period();
  const double served = std::exp(-(arrival - arrival_before) / kServiceTime) / kServiceTime;
  Ways ways;
  ways.on_time = (1.0 - stalls_) * filter.likelihood(arrival, offset);
  ways.queued = filter.readyBefore(arrival_before, offset) * served;
  ways.held_up = late > 0.0 ? stalls_ / kStallLength * std::exp(-late / kStallLength) : 0.0;
  return ways;
}

// Bayes' rule, for the frame's number, for the models, and for each model's clock.
void ExposureClock::weigh(double arrival) {
  const ClockFilter& leader = best();
  counter_.predict(
      frame_ + 1 +
      static_cast<std::int64_t>(std::floor((arrival - leader.time()) / leader.period())));
  std::array<double, FrameCounter::kCapacity> on_time;
  std::array<double, FrameCounter::kCapacity> number{};
  double sum = 0.0, on_steady_edge = 0.0;
  for (std::size_t m = 0; m < kModels; ++m) {
    ClockFilter& filter = filters_[m];
    double evidence = 0.0;
    for (int i = 0; i < counter_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double offset = static_cast<double>(counter_.frame(i) - frame_);
      const Ways ways = waysOf(filter, arrival, last_arrival_, offset);
      // Only what came when it was ready says something of the clock.
      on_time[at] = counter_[i] * ways.on_time;
      const double all = counter_[i] * (ways.sum() + kUnexplained);
      evidence += all;
      number[at] += weights_[m] * all;
    }
    for (int i = 0; i < counter_.size(); ++i) {
      const double probability = on_time[static_cast<std::size_t>(i)] / evidence;
      if (probability > kNegligible)
        filter.consider(arrival, static_cast<double>(counter_.frame(i) - frame_), probability);
      if (m == kSteadyEdge)
        on_steady_edge += probability;
    }
    filter.settle();
    weights_[m] *= evidence;
    sum += weights_[m];
  }
  unexplained_ = sum < 10.0 * kUnexplained ? unexplained_ + 1 : 0;
  for (double& weight : weights_)
    weight /= sum;
  for (int i = 0; i < counter_.size(); ++i)
    counter_[i] = number[static_cast<std::size_t>(i)];
  counter_.normalise();
  lookBack(arrival, on_steady_edge);
  sharpenEdge();
}

/// What the reports since the last time say in hindsight.
void ExposureClock::lookBack(double arrival, double on_time) {
  history_.add(counter_, arrival, on_time);
  if (!history_.settled())
    return;
  const ClockFilter& edge = filters_[kSteadyEdge];
  const int reports = history_.settle(counter_);
  for (int i = 0; i < reports; ++i) {
    const FrameHistory::Report& report = history_.report(i);
    if (report.probability > kSure) {
      const auto offset = static_cast<double>(report.frame - frame_);
      if (report.arrival - edge.time() - offset * edge.period() > -kTooEarly)
        edge_.add(report.frame, report.arrival, report.on_time, edge.period());
      learnStalls(waysOf(best(), report.arrival, settled_arrival_, offset));
      if (best().spread() < kTellable * best().period())
        counter_.learn(report.frame - settled_frame_);
    }
    settled_arrival_ = report.arrival;
    settled_frame_ = report.frame;
  }
}

/// A step of expectation maximisation.
void ExposureClock::learnStalls(const Ways& ways) {
  experience_ = std::min(experience_ + 1.0, kStallMemory);
  const double held_up = ways.held_up / (ways.sum() + kUnexplained);
  stalls_ += (held_up - stalls_) / (experience_ + kStallPrior);
  stalls_ = std::max(stalls_, kFewestStalls);
}

void ExposureClock::sharpenEdge() {
  ClockFilter& filter = filters_[kSteadyEdge];
  if (!edge_.ready())
    return;
  if (!edge_joined_) {  // what weighed its normal approximation until now says nothing of it
    edge_joined_ = true;
    weights_[kSteadyEdge] = std::max(weights_[kSteadyEdge], kPriorSteadyEdge);
  }
  ClockState state = edge_.state(frame_, filter.spread());
  state.p00 += square(kSteady) * kEdgeMemory;
  filter.believe(state);
}

void ExposureClock::reviveLosers() {
  const ClockFilter& leader = best();
  double sum = 0.0;
  for (std::size_t m = 0; m < kModels; ++m) {
    if (weights_[m] < kLeastWeight) {
      weights_[m] = kLeastWeight;
      if (m != kSteadyEdge || !edge_.ready())
        filters_[m].follow(leader);
      else if (std::abs(filters_[m].time() - leader.time()) > kContradiction)
        edge_.clear();
    }
    sum += weights_[m];
  }
  for (double& weight : weights_)
    weight /= sum;
}

Estimate ExposureClock::estimate(double arrival) {
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
    variance += weights_[m] * (filters_[m].timeVariance() + square(filters_[m].time() - time));

  // No frame is seen after it has arrived, nor before the one that was reported before it.
  const double exposure = std::max(std::min(time, arrival + std::min(3.0 * spread, period)),
                                   last_exposure_ + kLeastStep);
  double doubt = 0.0;
  for (int i = 0; i < counter_.size(); ++i)
    doubt += counter_[i] *
             square(time + static_cast<double>(counter_.frame(i) - frame_) * period - exposure);

  Estimate e;
  e.exposure = origin_ + exposure;
  e.clock_stddev = std::sqrt(variance);
  e.stddev = std::sqrt(variance + doubt);
  doubtful_ = e.stddev > options_.period ? doubtful_ + 1 : 0;
  e.frame = frame_;
  e.dropped = static_cast<int>(std::max<std::int64_t>(0, frame_ - previous - 1));
  e.stale = arrival - time > options_.stale_age;
  statistics_.dropped += frame_ - previous - 1;
  statistics_.stale += e.stale ? 1 : 0;
  last_arrival_ = arrival;
  last_exposure_ = exposure;
  return e;
}

Statistics ExposureClock::statistics() const {
  Statistics s = statistics_;
  s.period = best().period();
  s.period_stddev = std::sqrt(best().periodVariance());
  for (std::size_t m = 0; m < kModels; ++m) {
    s.jitter += weights_[m] * filters_[m].spread();
    s.hard_edge += filters_[m].model().hard_edge ? weights_[m] : 0.0;
  }
  return s;
}

}  // namespace wiimote_tracker::exposure_clock
