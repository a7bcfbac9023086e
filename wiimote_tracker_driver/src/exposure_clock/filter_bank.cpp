#include "exposure_clock/filter_bank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace wiimote_tracker::exposure_clock {

namespace {
// Blur of exponential delays [s]: negligible, or a slot of 1.25 ms (standard deviation 1.25 ms /
// sqrt(12)).
constexpr double kSharp = 10e-6;
constexpr double kSlotted = 0.36e-3;
// Wander after 1 s [s]: of a good clock (0.01 ms in 10 s), 0.3 ms and 1 ms in 10 s, and 5 ms in
// 10 s, the most of recordings of two remotes (2.5 to 5 ms). Only exponential delays without blur
// tell 0.3 from 1 ms; beside 5 ms a slot is negligible.
constexpr double kSteady = 0.003e-3;
constexpr double kWanders = 0.095e-3;
constexpr double kWandersMuch = 0.32e-3;
constexpr double kWandersAsRecorded = 1.58e-3;

// Of the period, relative, so that a remote may be fast or slow; it stays within three times this.
constexpr double kPeriodStddev = 2500e-6;

struct Prior {
  DelayModel model;
  double weight;  // only the ratios count
};
const Prior kPriors[] = {
    {{true, kSharp, kSteady, true}, 0.14},
    {{true, kSharp, kWanders}, 0.09},
    {{true, kSharp, kWandersMuch}, 0.10},
    {{true, kSharp, kWandersAsRecorded}, 0.10},
    {{true, kSlotted, kSteady}, 0.14},
    {{true, kSlotted, kWandersMuch}, 0.10},
    {{false, 0.0, kSteady}, 0.14},
    {{false, 0.0, kWandersMuch}, 0.10},
    {{false, 0.0, kWandersAsRecorded}, 0.10},
};

// Weight below which a filter follows the best one. With twice as much the stated deviations of
// exponential delays are 9 % larger.
constexpr double kMinWeight = 1.5e-4;
// The same of an exponential beside a normal distribution: normal delays may look like exponential
// ones for a second, while those soon contradict a normal distribution. A thousandth of this is as
// good. During the first reports of a link exponential delays look like normal ones, too, until
// their spread is known.
constexpr double kMinWeightOfExponential = 1e-9;
constexpr int kReportsForSpread = 100;
// Probability below which a frame number does not change a filter.
constexpr double kNegligible = 1e-6;
}  // namespace

FilterBank::FilterBank(double period) {
  static_assert(std::size(kPriors) == kModels, "models_ has room for these");
  for (const Prior& prior : kPriors)
    models_.push_back({ClockFilter(prior.model, period, period * kPeriodStddev), prior.weight});
}

void FilterBank::start(std::int64_t frame, double arrival) {
  for (Model& model : models_)
    model.filter.start(frame, arrival);
}

const ClockFilter& FilterBank::best() const {
  return std::max_element(models_.begin(), models_.end(),
                          [](const Model& a, const Model& b) { return a.weight < b.weight; })
      ->filter;
}

double FilterBank::update(const StallModel::Arrival& arrival,
                          const StallModel& stalls,
                          FrameCounter* numbers) {
  std::array<double, FrameCounter::kCapacity> on_time, number{};
  double sum = 0.0;
  for (Model& model : models_) {
    double evidence = 0.0;
    for (int i = 0; i < numbers->size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const StallModel::Density density = stalls.density(model.filter, numbers->frame(i), arrival);
      // Only reports that were on time are measurements of the clock.
      on_time[at] = (*numbers)[i] * density.on_time;
      const double all = (*numbers)[i] * density.sum();
      evidence += all;
      number[at] += model.weight * all;
    }
    ClockFilter::Hypotheses hypotheses;
    for (int i = 0; i < numbers->size(); ++i) {
      const double probability = on_time[static_cast<std::size_t>(i)] / evidence;
      if (probability > kNegligible)
        model.filter.addHypothesis(model.filter.predict(numbers->frame(i)), arrival.time,
                                   probability, &hypotheses);
    }
    model.filter.apply(hypotheses);
    model.weight *= evidence;
    sum += model.weight;
  }
  normalise();
  for (int i = 0; i < numbers->size(); ++i)
    (*numbers)[i] = number[static_cast<std::size_t>(i)];
  numbers->normalise();
  return sum;
}

void FilterBank::learn(std::int64_t frame, double arrival, double on_time) {
  for (Model& model : models_)
    model.filter.learn(frame, arrival, on_time);
  reports_ = std::min(reports_ + 1, kReportsForSpread + 1);
}

void FilterBank::advanceTo(std::int64_t frame) {
  for (Model& model : models_)
    model.filter.advanceTo(frame);
  const ClockFilter& likeliest = best();
  for (Model& model : models_) {
    const bool exponential_beside_normal =
        model.filter.model().exponential && !likeliest.model().exponential && linkIsKnown();
    const double least = exponential_beside_normal ? kMinWeightOfExponential : kMinWeight;
    if (model.weight < least) {
      model.weight = least;
      model.filter.follow(likeliest);
    }
  }
  normalise();
}

void FilterBank::normalise() {
  double sum = 0.0;
  for (const Model& model : models_)
    sum += model.weight;
  for (Model& model : models_)
    model.weight /= sum;
}

bool FilterBank::linkIsKnown() const {
  return reports_ > kReportsForSpread;
}

double FilterBank::exponentialProbability() const {
  double probability = 0.0;
  for (const Model& model : models_)
    probability += model.filter.model().exponential ? model.weight : 0.0;
  return probability;
}

FilterBank::Mean FilterBank::mean() const {
  Mean mean;
  for (const Model& model : models_) {
    mean.time += model.weight * model.filter.time();
    mean.period += model.weight * model.filter.period();
    mean.spread += model.weight * model.filter.spread();
  }
  for (const Model& model : models_)
    mean.variance +=
        model.weight * (model.filter.timeVariance() + std::pow(model.filter.time() - mean.time, 2));
  // If delays taken for normal are exponential, the exposures are off by so much.
  if (!linkIsKnown())
    mean.variance += (1.0 - exponentialProbability()) * std::pow(kTypicalNormalSpread, 2);
  return mean;
}

}  // namespace wiimote_tracker::exposure_clock
