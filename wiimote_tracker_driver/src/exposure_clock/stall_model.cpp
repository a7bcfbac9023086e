#include "exposure_clock/stall_model.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
// Mean time between reports that leave a queue [s].
constexpr double kServiceTime = 0.0025;
// Number of reports that the initial values count as, and of latest reports they are estimated
// from.
constexpr double kStallPrior = 300.0;
constexpr double kStallMemory = 6000.0;
// Share of reports that are always taken for held up, for this long [s].
constexpr double kMinStallProbability = 0.0005;
constexpr double kMinStallLength = 0.020;
}  // namespace

StallModel::Density StallModel::density(const ClockFilter& filter,
                                        std::int64_t frame,
                                        const Arrival& arrival) const {
  const ClockFilter::Prediction z = filter.predict(frame);
  const double late = arrival.time - z.exposure;
  if (arrival.waited)  // that says only that it was ready before; the constant factor cancels
    return {late, 0.0, filter.readyBefore(z, arrival.time) / filter.period(), 0.0};
  const double served = std::exp(-(arrival.time - arrival.before) / kServiceTime) / kServiceTime;
  const double rate = probability_ / time_;  // over the mean length [1/s]
  return {late, (1.0 - probability_) * filter.likelihood(z, arrival.time),
          filter.readyBefore(z, arrival.before) * served,
          late > 0.0 ? probability_ * rate * std::exp(-late * rate) : 0.0};
}

void StallModel::learn(const Density& density) {
  const double stalled = density.stalled / density.sum();
  reports_ = std::min(reports_ + 1.0, kStallMemory);
  const double gain = 1.0 / (reports_ + kStallPrior);
  probability_ += gain * (stalled + kMinStallProbability - probability_);
  time_ += gain * (stalled * density.late + kMinStallProbability * kMinStallLength - time_);
}

}  // namespace wiimote_tracker::exposure_clock
