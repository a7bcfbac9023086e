#include "exposure_clock/poll_watch.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
// In sniff mode a remote sends once in 16 slots of 0.625 ms [s].
constexpr double kSniffInterval = 0.010;
// Reports that a mean is taken over, for the longest interval; for the others less in proportion.
// So a camera whose period differs from the polls' by 2 us is not in step.
constexpr double kStepMemory = 1350.0;
// Reports that steady_ is a mean over: those of 0.8 s.
constexpr double kSteadyMemory = kStepMemory / 16.0;
constexpr double kInStep = 0.5;
// Weight of a mean from which on it tells: the polls have then passed once through all waits of a
// camera of nominal period.
constexpr double kEnough = 0.2;

double phase(double time, double interval) {
  return 2.0 * M_PI * std::fmod(time, interval) / interval;
}
}  // namespace

void PollWatch::add(double arrival) {
  double interval = kSniffInterval, memory = kStepMemory;
  for (Mean& mean : in_step_) {
    mean.sum += (std::polar(1.0, phase(arrival, interval)) - mean.sum) / memory;
    mean.weight += (1.0 - mean.weight) / memory;
    interval /= 2.0;
    memory /= 2.0;
  }
  steady_ += (std::cos(phase(arrival - last_arrival_, kSniffInterval)) - steady_) / kSteadyMemory;
  last_arrival_ = arrival;
}

double PollWatch::waitVariance() const {
  double interval = kSniffInterval;
  for (const Mean& mean : in_step_) {
    // The wait is then distributed uniformly.
    if (mean.weight > kEnough && std::abs(mean.sum) > kInStep * mean.weight)
      return std::max(0.0, steady_) * interval * interval / 12.0;
    interval /= 2.0;
  }
  return 0.0;
}

}  // namespace wiimote_tracker::exposure_clock
