#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Finds cameras whose computer has another clock than this one. An image carries its arrival time
/// by the camera's computer and is received at a time of this computer: the difference is the
/// transport delay plus the clock offset. The shortest of many delays is short and nearly the same
/// for all cameras.
class HostClockCheck {
 public:
  /// `tolerance`: smaller offsets may be transport delays [s].
  explicit HostClockCheck(double tolerance) : tolerance_(tolerance) {}

  void clear(std::size_t cameras) { shortest_.assign(cameras, std::nullopt); }

  /// `delay`: from the arrival time of an image to its receipt here [s].
  void add(std::size_t camera, double delay) {
    std::optional<double>& shortest = shortest_.at(camera);
    shortest = std::min(shortest.value_or(delay), delay);
  }

  /// How far the camera's clock is ahead of this computer's, or of most cameras' clocks [s];
  /// nothing when it agrees or no image came.
  std::optional<double> ahead(std::size_t camera) const {
    if (!shortest_.at(camera))
      return std::nullopt;
    const double delay = *shortest_[camera];
    // No image is received before it arrives.
    if (delay < -tolerance_)
      return -delay;
    std::vector<double> delays;
    for (const std::optional<double>& other : shortest_) {
      if (other)
        delays.push_back(*other);
    }
    // The lower of two middle values: a delay can be too long because of the network, not too
    // short.
    const auto middle = delays.begin() + (delays.size() - 1) / 2;
    std::nth_element(delays.begin(), middle, delays.end());
    const double offset = *middle - delay;
    if (std::abs(offset) <= tolerance_)
      return std::nullopt;
    return offset;
  }

 private:
  double tolerance_;
  std::vector<std::optional<double>> shortest_;  // per camera [s]
};

}  // namespace wiimote_tracker
