#include "wiimote_tracker_triangulation/fusion/frame_history.h"

#include <algorithm>

namespace wiimote_tracker::fusion {

std::optional<Eigen::Vector2d> Bracket::pixelAt(double t) const {
  if (!before->pixel || !after->pixel)
    return std::nullopt;
  if (before == after)
    return before->pixel;
  const double share = (t - before->time) / gap();
  return Eigen::Vector2d(*before->pixel + share * (*after->pixel - *before->pixel));
}

void FrameHistory::push(const Frame& frame) {
  if (size_ == kMaximumSize) {
    first_ = (first_ + 1) % ring_.size();
    --size_;
  }
  if (size_ == ring_.size()) {
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(first_), ring_.end());
    first_ = 0;
    ring_.resize(std::min(kMaximumSize, 2 * ring_.size() + 8));
  }
  ring_[(first_ + size_) % ring_.size()] = frame;
  ++size_;
}

void FrameHistory::forgetBefore(double t) {
  const std::size_t count = countUpTo(t);
  if (count < 2)
    return;
  first_ = (first_ + count - 1) % ring_.size();
  size_ -= count - 1;
}

std::optional<double> FrameHistory::firstTimeAfter(double t) const {
  const std::size_t i = countUpTo(t);
  if (i == size_)
    return std::nullopt;
  return at(i).time;
}

std::optional<Bracket> FrameHistory::bracket(double t) const {
  const std::size_t count = countUpTo(t);
  if (count == 0)
    return std::nullopt;
  const Frame& before = at(count - 1);
  if (before.time == t)
    return Bracket{&before, &before};
  if (count == size_)
    return std::nullopt;
  return Bracket{&before, &at(count)};
}

std::size_t FrameHistory::countUpTo(double t) const {
  std::size_t low = 0;
  std::size_t high = size_;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (at(middle).time <= t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

}  // namespace wiimote_tracker::fusion
