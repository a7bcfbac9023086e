#include "exposure_clock/frame_counter.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kNextLoss = 0.3;    // probability of a loss after a loss
constexpr double kDuplicate = 1e-4;  // probability of a duplicate report
constexpr double kFloor = 1e-9;      // least probability of each number
constexpr double kNegligibleShare = 1e-7;
// Number of reports that the initial loss probability counts as, number of latest reports it is
// estimated from, and its least value.
constexpr double kPrior = 300.0;
constexpr double kMemory = 1000.0;
constexpr double kMinLossProbability = 0.002;
}  // namespace

double FrameCounter::transition(std::int64_t frames) const {
  if (frames < 0)
    return 0.0;
  if (frames == 0)
    return kDuplicate;
  if (frames == 1)
    return 1.0 - loss_probability_;
  return kFloor + loss_probability_ * (1.0 - kNextLoss) * std::pow(kNextLoss, frames - 2);
}

void FrameCounter::learn(double lost, double kept) {
  sample_count_ = std::min(sample_count_ + 1.0, kMemory);
  loss_probability_ += (lost - (lost + kept) * loss_probability_) / (sample_count_ + kPrior);
  loss_probability_ = std::max(loss_probability_, kMinLossProbability);
}

void FrameCounter::copyLossesFrom(const FrameCounter& other) {
  loss_probability_ = other.loss_probability_;
  sample_count_ = other.sample_count_;
}

void FrameCounter::start(std::int64_t frame) {
  first_ = frame;
  size_ = 1;
  probability_[0] = 1.0;
}

// In place: each number is read before its probability is replaced.
void FrameCounter::predict(std::int64_t newest) {
  const std::int64_t earliest = first_;
  newest = std::max(newest, earliest + size_);
  first_ = std::max(earliest, newest - kCapacity + 1);
  double before = 0.0;  // probability of the frame before,
  double run = 0.0;     // and that it was lost
  for (std::int64_t frame = earliest; frame <= newest; ++frame) {
    const double same =
        frame < earliest + size_ ? (*this)[static_cast<int>(frame - earliest)] : 0.0;
    if (frame >= first_)
      (*this)[static_cast<int>(frame - first_)] =
          kDuplicate * same + (1.0 - loss_probability_) * before + (1.0 - kNextLoss) * run + kFloor;
    run = loss_probability_ * before + kNextLoss * run;
    before = same;
  }
  size_ = static_cast<int>(newest - first_ + 1);
}

void FrameCounter::normalise() {
  double sum = 0.0;
  for (int i = 0; i < size_; ++i)
    sum += (*this)[i];
  int begin = 0, end = size_;
  while (begin + 1 < end && (*this)[begin] < kNegligibleShare * sum)
    ++begin;
  while (end - 1 > begin && (*this)[end - 1] < kNegligibleShare * sum)
    --end;
  for (int i = begin; i < end; ++i)
    (*this)[i - begin] = (*this)[i] / sum;
  first_ += begin;
  size_ = end - begin;
}

std::int64_t FrameCounter::mostProbable() const {
  return first_ + (std::max_element(probability_.begin(), probability_.begin() + size_) -
                   probability_.begin());
}

}  // namespace wiimote_tracker::exposure_clock
