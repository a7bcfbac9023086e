#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CLOCK_WATCH_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CLOCK_WATCH_H

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Finds cameras whose computer has another clock than this one. An image carries its arrival time
/// by the camera's computer and is handled at a time of this computer: the difference is the
/// transport delay plus the clock offset. The shortest of many delays is short and nearly the same
/// for all cameras.
class ClockWatch {
 public:
  /// `tolerance`: smaller offsets may be transport delays [s].
  explicit ClockWatch(double tolerance) : tolerance_(tolerance) {}

  void clear(std::size_t cameras);

  /// `delay`: from the arrival time of an image to its handling here [s].
  void add(std::size_t camera, double delay);

  /// How far the camera's clock is ahead of this computer's, or of most cameras' clocks [s];
  /// nothing when it agrees or no image came.
  std::optional<double> ahead(std::size_t camera) const;

 private:
  double tolerance_;
  std::vector<std::optional<double>> shortest_;  // per camera [s]
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CLOCK_WATCH_H
