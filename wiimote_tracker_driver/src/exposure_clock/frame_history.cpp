#include "exposure_clock/frame_history.h"

#include <algorithm>
#include <numeric>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kDecided = 0.9999;  // probability of a number that later reports leave
constexpr int kNumbersBelow = 4;     // of those kept, below the most probable one
}  // namespace

void FrameHistory::add(const FrameCounter& numbers, double arrival, bool waited) {
  if (complete()) {
    entries_[0] = entries_[static_cast<std::size_t>(size_ - 1)];
    size_ = 1;
  }
  Entry& entry = entries_[static_cast<std::size_t>(size_++)];
  entry = {{arrival, waited, 0, 0.0, 0.0, 0.0},
           std::max(numbers.frame(0), numbers.mostProbable() - kNumbersBelow),
           {}};
  int number = static_cast<int>(entry.first - numbers.frame(0));
  for (double& probability : entry.probability)
    probability = number < numbers.size() ? numbers[number++] : 0.0;
  decide(&entry);
}

bool FrameHistory::complete() const {
  return size_ == kCapacity || (size_ > 0 && report(size_ - 1).probability > kDecided);
}

int FrameHistory::smooth(const FrameCounter& counter) {
  for (int i = size_ - 2; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    smoothEntry(counter, &entries_[at], &entries_[at + 1]);
    decide(&entries_[at]);
  }
  return size_;
}

// p(from, to | all) = p(from | so far) p(to | from) p(to | all) / p(to | so far)
void FrameHistory::smoothEntry(const FrameCounter& counter, Entry* entry, Entry* next) {
  std::array<double, kNumbers> smoothed{}, joint{};
  for (std::size_t to = 0; to < kNumbers; ++to) {
    if (next->probability[to] == 0.0)
      continue;
    const auto frames = [&](std::size_t from) {
      return next->first - entry->first + static_cast<std::int64_t>(to) -
             static_cast<std::int64_t>(from);
    };
    double predicted = 0.0;
    for (std::size_t from = 0; from < kNumbers; ++from) {
      joint[from] = entry->probability[from] * counter.transition(frames(from));
      predicted += joint[from];
    }
    for (std::size_t from = 0; from < kNumbers && predicted > 0.0; ++from) {
      const double both = joint[from] * next->probability[to] / predicted;
      smoothed[from] += both;
      next->report.lost += frames(from) > 1 ? both : 0.0;
      next->report.kept += frames(from) == 1 ? both : 0.0;
    }
  }
  entry->probability = smoothed;
}

void FrameHistory::decide(Entry* entry) {
  auto& p = entry->probability;
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  for (double& probability : p)
    probability /= sum > 0.0 ? sum : 1.0;
  const auto best = std::max_element(p.begin(), p.end());
  entry->report.frame = entry->first + (best - p.begin());
  entry->report.probability = *best;
}

}  // namespace wiimote_tracker::exposure_clock
