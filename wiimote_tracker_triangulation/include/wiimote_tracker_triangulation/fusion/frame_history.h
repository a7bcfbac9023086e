#pragma once

#include "wiimote_tracker_triangulation/tracking/numbered_queue.h"

#include <cstddef>
#include <cstdint>
#include <optional>

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

  bool empty() const { return frames_.empty(); }
  const Frame& newest() const { return frames_.back(); }

  /// The frame's time must be above that of newest().
  void push(const Frame& frame) {
    if (frames_.size() == kMaximumSize)
      frames_.popFront();
    frames_.push() = frame;
  }

  /// Drops what is not needed after t: all images before the last one at or before t.
  void forgetBefore(double t) {
    const std::uint64_t next = firstAfter(t);
    while (frames_.begin() + 1 < next)
      frames_.popFront();
  }

  /// Time of the first image after t; nothing when there is none.
  std::optional<double> firstTimeAfter(double t) const {
    const std::uint64_t next = firstAfter(t);
    if (next == frames_.end())
      return std::nullopt;
    return frames_.at(next).time;
  }

  /// The last image at or before t; null when there is none.
  const Frame* lastUpTo(double t) const {
    const std::uint64_t next = firstAfter(t);
    return next == frames_.begin() ? nullptr : &frames_.at(next - 1);
  }

  /// Nothing when t lies outside the images kept.
  std::optional<Bracket<Frame>> bracket(double t) const {
    const std::uint64_t next = firstAfter(t);
    if (next == frames_.begin())
      return std::nullopt;
    const Frame& before = frames_.at(next - 1);
    if (before.time == t)
      return Bracket<Frame>{&before, &before};
    if (next == frames_.end())
      return std::nullopt;
    return Bracket<Frame>{&before, &frames_.at(next)};
  }

  void clear() { frames_.clear(); }

 private:
  /// Number of the first image after t, or one past the last.
  std::uint64_t firstAfter(double t) const {
    std::uint64_t low = frames_.begin();
    std::uint64_t high = frames_.end();
    while (low < high) {
      const std::uint64_t middle = (low + high) / 2;
      if (frames_.at(middle).time <= t)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }

  tracking::NumberedQueue<Frame> frames_;
};

}  // namespace wiimote_tracker::fusion
