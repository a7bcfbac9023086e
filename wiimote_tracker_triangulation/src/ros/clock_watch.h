#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CLOCK_WATCH_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CLOCK_WATCH_H

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Finds cameras whose computer's clock does not agree with this computer's. An image is stamped
/// with its arrival by the clock over there and is handled by the clock here; the difference is the
/// way between, which takes time, plus the offset of the clocks. The shortest way of many is short
/// and much the same for all cameras.
class ClockWatch {
 public:
  /// `tolerance`: offsets up to this are taken for delays [s].
  explicit ClockWatch(double tolerance) : tolerance_(tolerance) {}

  /// Forgets all.
  void clear(std::size_t cameras);

  /// `delay`: from the arrival that an image carries to its handling here [s].
  void add(std::size_t camera, double delay);

  /// How far the camera's clock is ahead of this computer's, or of most cameras' [s]; nothing when
  /// it agrees, or nothing is known.
  std::optional<double> ahead(std::size_t camera) const;

 private:
  double tolerance_;
  std::vector<std::optional<double>> shortest_;  // per camera [s]
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CLOCK_WATCH_H
