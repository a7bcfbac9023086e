#include "clock_watch.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker {

void ClockWatch::clear(std::size_t cameras) {
  shortest_.assign(cameras, std::nullopt);
}

void ClockWatch::add(std::size_t camera, double delay) {
  std::optional<double>& shortest = shortest_.at(camera);
  shortest = std::min(shortest.value_or(delay), delay);
}

std::optional<double> ClockWatch::ahead(std::size_t camera) const {
  if (!shortest_.at(camera))
    return std::nullopt;
  const double delay = *shortest_[camera];
  // No image is handled before it arrives.
  if (delay < -tolerance_)
    return -delay;
  std::vector<double> delays;
  for (const std::optional<double>& other : shortest_) {
    if (other)
      delays.push_back(*other);
  }
  // The lower of two middle values: a delay can be too long because of the network, not too short.
  const auto middle = delays.begin() + static_cast<std::ptrdiff_t>((delays.size() - 1) / 2);
  std::nth_element(delays.begin(), middle, delays.end());
  const double offset = *middle - delay;
  if (std::abs(offset) <= tolerance_)
    return std::nullopt;
  return offset;
}

}  // namespace wiimote_tracker
