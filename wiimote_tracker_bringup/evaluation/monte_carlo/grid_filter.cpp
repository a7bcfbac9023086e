#include "grid_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kCell = 1e-4;          // of the delay [s]
constexpr std::size_t kCells = 1200;    // up to 120 ms
constexpr double kMean = 0.005;         // delay before the poll [s]
constexpr double kJitter = 0.0014;      // its standard deviation [s]
constexpr double kPoll = 0.0056;        // between polls [s]
constexpr double kResolution = 1e-3;    // of the recorded times [s]
constexpr double kHeldUpShare = 0.02;   // of the reports
constexpr double kHeldUpTime = 0.02;    // mean [s]
constexpr double kWalk = 0.0019;        // of the phase after 1 s [s]
constexpr double kLost = 0.05;          // probability that a frame is lost
constexpr double kNextLost = 0.2;       // the same, if the one before was lost
constexpr int kMostFrames = 12;         // from one report to the next
constexpr double kUnexplained = 1e-12;  // of each cell, as after long gaps

using Density = std::vector<double>;

Density convolve(const Density& density, const Density& kernel, std::ptrdiff_t first) {
  Density result(kCells, 0.0);
  for (std::size_t i = 0; i < kCells; ++i) {
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i + k) + first;
      if (at >= 0 && at < static_cast<std::ptrdiff_t>(kCells))
        result[static_cast<std::size_t>(at)] += density[i] * kernel[k];
    }
  }
  return result;
}

void normalise(Density& density) {
  double sum = 0.0;
  for (const double d : density)
    sum += d;
  for (double& d : density)
    d /= sum;
}

Density bell(double mean, double stddev, std::size_t cells) {
  Density density(cells);
  for (std::size_t i = 0; i < cells; ++i)
    density[i] =
        std::exp(-0.5 * std::pow(((static_cast<double>(i) + 0.5) * kCell - mean) / stddev, 2));
  normalise(density);
  return density;
}

/// Density of a report's delay: Gaussian, plus the wait for the poll, plus rounding; some reports
/// are held up as well.
Density delays() {
  const auto box = [](double width) {
    const double cells = std::round(width / kCell);
    return Density(static_cast<std::size_t>(cells), 1.0 / cells);
  };
  Density density = convolve(bell(kMean, kJitter, kCells), box(kPoll), 0);
  const Density rounding = box(kResolution);
  density = convolve(density, rounding, -static_cast<std::ptrdiff_t>(rounding.size() / 2));
  normalise(density);
  Density queue(kCells);
  for (std::size_t i = 0; i < kCells; ++i)
    queue[i] = std::exp(-static_cast<double>(i) * kCell / kHeldUpTime);
  Density held_up = convolve(density, queue, 0);
  normalise(held_up);
  for (std::size_t i = 0; i < kCells; ++i)
    density[i] = (1.0 - kHeldUpShare) * density[i] + kHeldUpShare * held_up[i];
  return density;
}

double transition(int frames) {
  return frames == 1 ? 1.0 - kLost : kLost * (1.0 - kNextLost) * std::pow(kNextLost, frames - 2);
}

/// Adds `weight` times the density of the delay after it has grown by `change` [s].
void addShifted(const Density& density, double change, double weight, Density* sum) {
  for (std::size_t i = 0; i < kCells; ++i) {
    const double from = static_cast<double>(i) - change / kCell;
    const double below = std::floor(from);
    if (below < 0.0 || below + 1.0 >= static_cast<double>(kCells))
      continue;
    const auto at = static_cast<std::size_t>(below);
    const double share = from - below;
    (*sum)[i] += weight * ((1.0 - share) * density[at] + share * density[at + 1]);
  }
}

}  // namespace

std::vector<GridStamp> gridStamps(const std::vector<double>& arrivals, double period) {
  constexpr std::size_t kReach = 8;  // of the wander of one period, in cells
  const Density likelihood = delays();
  const Density walk =
      bell((static_cast<double>(kReach) + 0.5) * kCell, kWalk * std::sqrt(period), 2 * kReach + 1);
  Density delay = likelihood;
  std::vector<GridStamp> stamps;
  stamps.reserve(arrivals.size());
  for (std::size_t n = 0; n < arrivals.size(); ++n) {
    if (n > 0) {
      Density predicted(kCells, 0.0);
      for (int frames = 1; frames <= kMostFrames; ++frames)
        addShifted(delay, arrivals[n] - arrivals[n - 1] - frames * period, transition(frames),
                   &predicted);
      delay = convolve(predicted, walk, -static_cast<std::ptrdiff_t>(kReach));
      for (std::size_t i = 0; i < kCells; ++i)
        delay[i] = (delay[i] + kUnexplained) * likelihood[i];
      normalise(delay);
    }
    double mean = 0.0, square = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
      const double x = (static_cast<double>(i) + 0.5) * kCell;
      mean += delay[i] * x;
      square += delay[i] * x * x;
    }
    stamps.push_back({arrivals[n] - mean, std::sqrt(std::max(0.0, square - mean * mean))});
  }
  return stamps;
}

}  // namespace wiimote_tracker::monte_carlo
