#ifndef WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_HISTORY_H
#define WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_HISTORY_H

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

/// What one camera saw in one image.
struct Frame {
  double time = 0.0;                     ///< Of the exposure [s].
  double arrival = 0.0;                  ///< When it reached the computer [s].
  std::optional<Eigen::Vector2d> pixel;  ///< The spot [px]; nothing unless there was exactly one.
};

/// The images of one camera on both sides of an instant; the same one twice when it was taken just
/// then.
struct Bracket {
  const Frame* before;
  const Frame* after;

  double gap() const { return after->time - before->time; }

  /// The pixel at time t, linearly interpolated. Nothing unless both images show one spot.
  std::optional<Eigen::Vector2d> pixelAt(double t) const;
};

/// The latest images of one camera, in the order of their times. Allocates only while it grows to
/// its working size.
class FrameHistory {
 public:
  /// Most images kept; older ones are dropped.
  static constexpr std::size_t kMaximumSize = 1024;

  bool empty() const { return size_ == 0; }
  const Frame& newest() const { return at(size_ - 1); }

  /// The frame's time must be above that of newest().
  void push(const Frame& frame);

  /// Drops what no instant after t needs: all images before the last one at or before t.
  void forgetBefore(double t);

  /// Time of the first image after t; nothing when there is none.
  std::optional<double> firstTimeAfter(double t) const;

  /// Nothing when t lies outside the images kept.
  std::optional<Bracket> bracket(double t) const;

  void clear() { size_ = 0; }

 private:
  const Frame& at(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  std::size_t countUpTo(double t) const;  // images at or before t

  std::vector<Frame> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_HISTORY_H
