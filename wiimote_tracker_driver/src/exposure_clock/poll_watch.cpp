#include "exposure_clock/poll_watch.h"

#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
// In sniff mode a remote sends once in 16 slots of 0.625 ms [s].
constexpr double kSniffInterval = 0.010;
// With kInStep 0.35 or 0.7, or half or twice kStepMemory, benchmark_radio prints the same figures.
//
// Length of a mean from which on polls are in step: the share of the arrivals that are, where the
// others come at random; so most are. If all come at random, it is reached with a probability of
// exp(-n / 4) (Rayleigh's test): 1e-4 for the fewest reports that tell, which count as n = 36.
constexpr double kInStep = 0.5;
// Greatest error of an adapter's clock in sniff mode (Bluetooth Core, Vol 2 Part B, sec. 1.1).
constexpr double kClockError = 250e-6;
// Reports that a mean is taken over, for the longest interval; for the others less in proportion:
// so many that polls by such a clock are still in step. By a phase that advances by w from report
// to report, 10 % more with lost images, the length of a mean becomes 1 / sqrt(1 + (w memory)^2).
const double kStepMemory =
    std::sqrt(1.0 / (kInStep * kInStep) - 1.0) / (2.0 * M_PI * kClockError * 1.1);
// Weight of a mean from which on it tells: the polls have then passed once through all waits of a
// camera of nominal period, after 286 images.
const double kEnough =
    1.0 - std::exp(-kSniffInterval / (kNominalPeriod - kSniffInterval) / kStepMemory);
// Reports that steady_ is a mean over: those of 0.8 s. Half or twice of it changes in_2sd% there by
// at most 0.8.
constexpr double kSteadyMemory = 84.0;

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
