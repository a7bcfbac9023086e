#include "grid_stamps.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kPeriod = 0.010035;    // between frames, to begin with [s]
constexpr double kCell = 1e-4;          // of the delay [s]
constexpr Eigen::Index kCells = 1200;   // up to 120 ms
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

using Density = Eigen::ArrayXd;

/// The sum of an independent delay, whose first cell is number `first`.
Density convolve(const Density& density, const Density& kernel, Eigen::Index first) {
  Density result = Density::Zero(kCells);
  for (Eigen::Index k = 0; k < kernel.size(); ++k) {
    const Eigen::Index shift = first + k;
    const Eigen::Index count = std::max<Eigen::Index>(kCells - std::abs(shift), 0);
    result.segment(std::max<Eigen::Index>(shift, 0), count) +=
        kernel[k] * density.segment(std::max<Eigen::Index>(-shift, 0), count);
  }
  return result;
}

/// The delays in the middle of cells [s].
Density middles(Eigen::Index cells) {
  return kCell * Density::LinSpaced(cells, 0.5, static_cast<double>(cells) - 0.5);
}

Density normal(double mean, double stddev, Eigen::Index cells) {
  const Density density = (-0.5 * ((middles(cells) - mean) / stddev).square()).exp();
  return density / density.sum();
}

/// Density of a report's delay: Gaussian, plus the wait for the poll, plus rounding; some reports
/// are held up as well.
Density delays() {
  const auto box = [](double width) -> Density {
    const double cells = std::round(width / kCell);
    return Density::Constant(static_cast<Eigen::Index>(cells), 1.0 / cells);
  };
  const Density rounding = box(kResolution);
  Density density = convolve(normal(kMean, kJitter, kCells), box(kPoll), 0);
  density = convolve(density, rounding, -(rounding.size() / 2));
  density /= density.sum();
  const Density held_up = convolve(density, (-middles(kCells) / kHeldUpTime).exp(), 0);
  return (1.0 - kHeldUpShare) * density + kHeldUpShare / held_up.sum() * held_up;
}

double transition(int frames) {
  return frames == 1 ? 1.0 - kLost : kLost * (1.0 - kNextLost) * std::pow(kNextLost, frames - 2);
}

/// Adds `weight` times the density of the delay after it has grown by `change` [s].
void addShifted(const Density& density, double change, double weight, Density* sum) {
  const double below = std::floor(-change / kCell);
  const double share = -change / kCell - below;
  if (std::abs(below) >= static_cast<double>(kCells))
    return;
  const auto from = static_cast<Eigen::Index>(below);
  const Eigen::Index begin = std::max<Eigen::Index>(-from, 0);
  const Eigen::Index count = std::min(kCells, kCells - 1 - from) - begin;
  if (count > 0)
    sum->segment(begin, count) += weight * ((1.0 - share) * density.segment(begin + from, count) +
                                            share * density.segment(begin + from + 1, count));
}

/// Mean and standard deviation of the exposure.
GridStamp stampOf(double arrival, const Density& delay) {
  const Density x = middles(kCells);
  const double mean = (delay * x).sum();
  return {arrival - mean, std::sqrt(std::max(0.0, (delay * x.square()).sum() - mean * mean))};
}

/// Forward-backward recursion (Rabiner, Proc. IEEE 77, 1989, eq. 20, 25 and 27).
GridStamps recursion(const std::vector<double>& arrivals, double period) {
  constexpr Eigen::Index kReach = 8;  // of the wander of one period, in cells
  const Density likelihood = delays();
  const Density walk = normal((kReach + 0.5) * kCell, kWalk * std::sqrt(period), 2 * kReach + 1);
  // The delays of report n by those of the one before; `direction` -1: the other way.
  const auto next = [&](const Density& delay, std::size_t n, double direction) {
    Density sum = Density::Zero(kCells);
    for (int frames = 1; frames <= kMostFrames; ++frames)
      addShifted(delay, direction * (arrivals[n] - arrivals[n - 1] - frames * period),
                 transition(frames), &sum);
    return sum;
  };
  GridStamps stamps;
  std::vector<Density> forward{likelihood / likelihood.sum()};
  for (std::size_t n = 1; n < arrivals.size(); ++n) {
    const Density delay =
        (convolve(next(forward.back(), n, 1.0), walk, -kReach) + kUnexplained) * likelihood;
    forward.push_back(delay / delay.sum());
  }
  for (std::size_t n = 0; n < arrivals.size(); ++n)
    stamps.filtered.push_back(stampOf(arrivals[n], forward[n]));
  stamps.smoothed.resize(arrivals.size());
  Density later = Density::Ones(kCells);  // density of the later arrivals, given the delay
  for (std::size_t n = arrivals.size(); n-- > 0;) {
    const Density delay = forward[n] * later;
    stamps.smoothed[n] = stampOf(arrivals[n], delay / delay.sum());
    if (n == 0)
      break;
    later *= likelihood;
    later = next(convolve(later, walk, -kReach), n, -1.0) + kUnexplained * later.sum();
    later /= later.sum();
  }
  return stamps;
}

/// Mean time between frames [s].
double periodOf(const std::vector<GridStamp>& stamps) {
  double frames = 0.0;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    frames += std::round((stamps[i].exposure - stamps[i - 1].exposure) / kPeriod);
  return (stamps.back().exposure - stamps.front().exposure) / frames;
}

}  // namespace

GridStamps gridStamps(const std::vector<double>& arrivals) {
  return recursion(arrivals, periodOf(recursion(arrivals, kPeriod).smoothed));
}

}  // namespace wiimote_tracker::monte_carlo
