#include "wiimote_tracker_driver/exposure_clock/frame_counter.h"

#include <algorithm>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kDrop = 0.04;      // probability that a frame is lost,
constexpr double kNextDrop = 0.3;   // and the one after a lost one
constexpr double kLeast = 1e-8;     // of a run of any length
constexpr double kNegligible = 1e-7;
}  // namespace

void FrameCounter::start(std::int64_t frame) {
  first_ = frame;
  size_ = 1;
  probability_[0] = 1.0;
}

void FrameCounter::predict(std::int64_t newest) {
  const std::int64_t before = first_ + 1;
  newest = std::max(newest, before + size_ - 1);  // at least one after the newest of before
  const std::int64_t first = std::max(before, newest - kCapacity + 1);
  std::array<double, kCapacity> next{};
  double run = 0.0;  // probability of being within a run of losses
  for (std::int64_t frame = before; frame <= newest; ++frame) {
    const std::int64_t i = frame - before;
    const double direct = i < size_ ? probability_[i] : 0.0;
    const double p = (1.0 - kDrop) * direct + (1.0 - kNextDrop) * run;
    run = kDrop * direct + kNextDrop * run;
    if (frame >= first)
      next[frame - first] = p + kLeast;
    else if (i >= size_)
      frame = std::max(frame, first - 64);
  }
  probability_ = next;
  first_ = first;
  size_ = static_cast<int>(newest - first + 1);
}

void FrameCounter::normalise() {
  double sum = 0.0;
  for (int i = 0; i < size_; ++i)
    sum += probability_[i];
  int begin = 0, end = size_;
  while (begin + 1 < end && probability_[begin] < kNegligible * sum)
    ++begin;
  while (end - 1 > begin && probability_[end - 1] < kNegligible * sum)
    --end;
  for (int i = begin; i < end; ++i)
    probability_[i - begin] = probability_[i] / sum;
  first_ += begin;
  size_ = end - begin;
}

}  // namespace wiimote_tracker::exposure_clock
