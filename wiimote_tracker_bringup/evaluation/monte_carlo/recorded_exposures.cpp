#include "reference_stamps.h"

#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kPeriod = 0.010035;  // between frames [s]
constexpr double kDelay = 0.005;      // mean [s]
constexpr double kSpread = 0.002;     // standard deviation of the delays [s]
constexpr double kWander = 0.0012;    // of the phase after 1 s, as the recordings have it [s]
constexpr double kEarly = 0.0015;     // cost of a report before its mean: its square over this [s]
constexpr double kLate = 0.0022;      // ... and after it [s]
constexpr double kTail = 6.0;         // cost of a report that was held up ...
constexpr double kTailScale = 0.006;  // ... rises by one in this time [s]
constexpr double kLostCost = 3.0;     // -log probability of a lost frame ...
constexpr double kNextCost = 1.2;     // ... and of each one after it
constexpr int kRounds = 20;
constexpr std::size_t kChoices = 6;  // of an arrival's frame number

double costOf(double late) {
  const double squared = std::pow(late / (late > 0.0 ? kLate : kEarly), 2);
  return late > 0.0 ? std::min(squared, kTail + late / kTailScale) : squared;
}

/// Least squares of arrival over frame number.
double periodOf(const std::vector<double>& arrivals, const std::vector<double>& numbers) {
  const auto count = static_cast<Eigen::Index>(arrivals.size());
  const Eigen::Map<const Eigen::ArrayXd> n(numbers.data(), count), a(arrivals.data(), count);
  const Eigen::ArrayXd off = n - n.mean();
  return (off * (a - a[0])).sum() / off.square().sum();
}

/// Mean time at which the report of each frame comes, given the numbers [s].
std::vector<double> smooth(const std::vector<double>& arrivals,
                           const std::vector<double>& numbers,
                           double period) {
  const std::size_t count = arrivals.size();
  std::vector<double> phase(count), variance(count);  // filtered, then smoothed [s, s^2]
  double mean = arrivals[0] - numbers[0] * period;
  double spread = kSpread * kSpread;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0)
      spread += kWander * kWander * kPeriod * (numbers[i] - numbers[i - 1]);
    const double late = arrivals[i] - numbers[i] * period - mean;
    // Far outliers count less.
    const double noise = std::max(kSpread * kSpread, 0.25 * late * late);
    const double gain = spread / (spread + noise);
    mean += gain * late;
    spread -= gain * spread;
    phase[i] = mean;
    variance[i] = spread;
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    const double walk = kWander * kWander * kPeriod * (numbers[i + 1] - numbers[i]);
    phase[i] += variance[i] / (variance[i] + walk) * (phase[i + 1] - phase[i]);
  }
  for (std::size_t i = 0; i < count; ++i)
    phase[i] += numbers[i] * period;
  return phase;
}

/// The most probable numbers, if the reports came at these times on average.
std::vector<double> renumber(const std::vector<double>& arrivals,
                             const std::vector<double>& numbers,
                             const std::vector<double>& expected,
                             double period) {
  struct Choice {
    double number;
    double cost;
    std::size_t before;
  };
  std::vector<std::array<Choice, kChoices>> choices(arrivals.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const double nearest = numbers[i] + std::round((arrivals[i] - expected[i]) / period);
    for (std::size_t k = 0; k < kChoices; ++k) {
      Choice& choice = choices[i][k];
      choice = {nearest + static_cast<double>(k) - 4.0, i == 0 ? 0.0 : 1e300, 0};
      for (std::size_t j = 0; i > 0 && j < kChoices; ++j) {
        const double step = choice.number - choices[i - 1][j].number;
        if (step < 1.0)
          continue;
        const double cost =
            choices[i - 1][j].cost + (step > 1.0 ? kLostCost + kNextCost * (step - 2.0) : 0.0);
        if (cost < choice.cost) {
          choice.cost = cost;
          choice.before = j;
        }
      }
      choice.cost += costOf(arrivals[i] - expected[i] - (choice.number - numbers[i]) * period);
    }
  }
  std::vector<double> result(arrivals.size());
  auto at =
      static_cast<std::size_t>(std::min_element(choices.back().begin(), choices.back().end(),
                                                [](auto& a, auto& b) { return a.cost < b.cost; }) -
                               choices.back().begin());
  for (std::size_t i = arrivals.size(); i-- > 0;) {
    result[i] = choices[i][at].number;
    at = choices[i][at].before;
  }
  return result;
}

}  // namespace

std::vector<double> recordedExposures(const std::vector<double>& arrivals) {
  exposure_clock::ExposureClock clock;  // for numbers to begin with
  std::vector<double> numbers;
  for (const double arrival : arrivals) {
    const auto number = static_cast<double>(clock.update(arrival).frame);
    numbers.push_back(numbers.empty() ? number : std::max(number, numbers.back() + 1.0));
  }
  std::vector<double> times;
  for (int round = 0; round < kRounds; ++round) {
    const double period = periodOf(arrivals, numbers);
    times = smooth(arrivals, numbers, period);
    const std::vector<double> better = renumber(arrivals, numbers, times, period);
    if (better == numbers)
      break;
    numbers = better;
  }
  for (double& time : times)
    time -= kDelay;
  return times;
}

}  // namespace wiimote_tracker::monte_carlo
