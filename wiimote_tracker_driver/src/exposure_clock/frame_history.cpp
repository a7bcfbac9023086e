#include "exposure_clock/frame_history.h"

#include <algorithm>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kCertainToDrop = 0.9999;
constexpr int kNumbersBelow = 4;  // of those kept, below the most probable one
}  // namespace

void FrameHistory::add(const FrameCounter& numbers, double arrival, double on_time) {
  if (size_ == kCapacity)
    return;
  Entry& entry = entries_[static_cast<std::size_t>(size_++)];
  entry.report = {arrival, on_time, 0, 0.0};
  entry.first = std::max(numbers.frame(0), numbers.mostProbable() - kNumbersBelow);
  const int skipped = static_cast<int>(entry.first - numbers.frame(0));
  entry.size = std::min(kNumbers, numbers.size() - skipped);
  for (int i = 0; i < entry.size; ++i)
    entry.probability[static_cast<std::size_t>(i)] = numbers[skipped + i];
  decide(entry);
}

bool FrameHistory::complete() const {
  return size_ == kCapacity || (size_ > 0 && report(size_ - 1).probability > kCertainToDrop);
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

void FrameHistory::smoothEntry(const FrameCounter& counter, const Entry& next, Entry* entry) {
  const auto transition = [&](int from, int to) {
    return counter.transition(next.first + to - entry->first - from);
  };
  std::array<double, kNumbers> factor{};
  for (int to = 0; to < next.size; ++to) {
    double predicted = 0.0;
    for (int from = 0; from < entry->size; ++from)
      predicted += entry->probability[static_cast<std::size_t>(from)] * transition(from, to);
    if (predicted > 0.0)
      for (int from = 0; from < entry->size; ++from)
        factor[static_cast<std::size_t>(from)] +=
            transition(from, to) * next.probability[static_cast<std::size_t>(to)] / predicted;
  }
  for (std::size_t i = 0; i < kNumbers; ++i)
    entry->probability[i] *= factor[i];
}

void FrameHistory::decide(Entry& entry) {
  double sum = 0.0;
  int best = 0;
  for (int i = 0; i < entry.size; ++i) {
    const double p = entry.probability[static_cast<std::size_t>(i)];
    sum += p;
    if (p > entry.probability[static_cast<std::size_t>(best)])
      best = i;
  }
  entry.report.frame = entry.first + best;
  entry.report.probability =
      sum > 0.0 ? entry.probability[static_cast<std::size_t>(best)] / sum : 0.0;
}

}  // namespace wiimote_tracker::exposure_clock
