#include "exposure_clock/frame_history.h"

#include <algorithm>
#include <numeric>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kDecided = 0.9999;  // probability of a number that later reports leave
constexpr int kNumbersBelow = 4;     // of those kept, below the most probable one
}  // namespace

void FrameHistory::add(const FrameCounter& numbers, double arrival, double on_time) {
  if (size_ == kCapacity)
    return;
  Entry& entry = entries_[static_cast<std::size_t>(size_++)];
  entry = {{arrival, on_time, 0, 0.0},
           std::max(numbers.frame(0), numbers.mostProbable() - kNumbersBelow),
           {}};
  int number = static_cast<int>(entry.first - numbers.frame(0));
  for (double& probability : entry.probability)
    probability = number < numbers.size() ? numbers[number++] : 0.0;
  decide(entry);
}

bool FrameHistory::complete() const {
  return size_ == kCapacity || (size_ > 0 && report(size_ - 1).probability > kDecided);
}

int FrameHistory::smooth(const FrameCounter& counter) {
  const int size = size_;
  for (int i = size - 2; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    smoothEntry(counter, entries_[at + 1], &entries_[at]);
    decide(entries_[at]);
  }
  size_ = 0;
  return size;
}

// p(from | all) = p(from | so far) * sum over `to` of p(to | from) p(to | all) / p(to | so far)
void FrameHistory::smoothEntry(const FrameCounter& counter, const Entry& next, Entry* entry) {
  std::array<double, kNumbers> factor{}, transition{};
  for (std::size_t to = 0; to < kNumbers; ++to) {
    if (next.probability[to] == 0.0)
      continue;
    double predicted = 0.0;
    for (std::size_t from = 0; from < kNumbers; ++from) {
      const auto step = static_cast<std::int64_t>(to) - static_cast<std::int64_t>(from);
      transition[from] = counter.transition(next.first - entry->first + step);
      predicted += entry->probability[from] * transition[from];
    }
    for (std::size_t from = 0; from < kNumbers && predicted > 0.0; ++from)
      factor[from] += transition[from] * next.probability[to] / predicted;
  }
  for (std::size_t i = 0; i < kNumbers; ++i)
    entry->probability[i] *= factor[i];
}

void FrameHistory::decide(Entry& entry) {
  const auto& p = entry.probability;
  const auto best = std::max_element(p.begin(), p.end());
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  entry.report.frame = entry.first + (best - p.begin());
  entry.report.probability = sum > 0.0 ? *best / sum : 0.0;
}

}  // namespace wiimote_tracker::exposure_clock
