#ifndef WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_HISTORY_H
#define WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_HISTORY_H

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

/// The images of one camera before and after an instant; the same one twice when its time is the
/// instant.
template <typename Frame>
struct Bracket {
  const Frame* before;
  const Frame* after;

  double gap() const { return after->time - before->time; }

  /// Interpolation weight of `after` at a time t.
  double shareAt(double t) const { return before == after ? 0.0 : (t - before->time) / gap(); }
};

/// The latest images of one camera, in the order of their times: Frame::time [s]. Does not allocate
/// once it has grown to its working size, if assigning a Frame does not.
template <typename Frame>
class FrameHistory {
 public:
  /// Older images are dropped.
  static constexpr std::size_t kMaximumSize = 1024;

  bool empty() const { return size_ == 0; }
  const Frame& newest() const { return at(size_ - 1); }

  /// The frame's time must be above that of newest().
  void push(const Frame& frame) {
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

  /// Drops what is not needed after t: all images before the last one at or before t.
  void forgetBefore(double t) {
    const std::size_t count = countUpTo(t);
    if (count < 2)
      return;
    first_ = (first_ + count - 1) % ring_.size();
    size_ -= count - 1;
  }

  /// Time of the first image after t; nothing when there is none.
  std::optional<double> firstTimeAfter(double t) const {
    const std::size_t i = countUpTo(t);
    if (i == size_)
      return std::nullopt;
    return at(i).time;
  }

  /// The last image at or before t; null when there is none.
  const Frame* lastUpTo(double t) const {
    const std::size_t count = countUpTo(t);
    return count == 0 ? nullptr : &at(count - 1);
  }

  /// Nothing when t lies outside the images kept.
  std::optional<Bracket<Frame>> bracket(double t) const {
    const std::size_t count = countUpTo(t);
    if (count == 0)
      return std::nullopt;
    const Frame& before = at(count - 1);
    if (before.time == t)
      return Bracket<Frame>{&before, &before};
    if (count == size_)
      return std::nullopt;
    return Bracket<Frame>{&before, &at(count)};
  }

  void clear() { size_ = 0; }

 private:
  const Frame& at(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }

  std::size_t countUpTo(double t) const {  // images at or before t
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

  std::vector<Frame> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_HISTORY_H
