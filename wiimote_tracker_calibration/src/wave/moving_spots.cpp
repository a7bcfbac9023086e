#include "moving_spots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

// A lamp's spot stays within this [px].
constexpr double kImageCell = 8.0;
// Smallest share of the frames in which a lamp is at one place; a moving LED is far below.
constexpr double kLampShare = 0.25;
// Fewest frames to find lamps in.
constexpr std::size_t kLeastFrames = 100;

using Cell = std::pair<int, int>;

Cell cellOf(const Eigen::Vector2d& spot) {
  return {static_cast<int>(std::floor(spot.x() / kImageCell)),
          static_cast<int>(std::floor(spot.y() / kImageCell))};
}

}  // namespace

std::vector<Frame> movingSpots(const std::vector<Frame>& frames) {
  std::map<Cell, std::size_t> frames_with_spot;
  std::size_t with_spots = 0;
  for (const Frame& frame : frames) {
    with_spots += frame.spots.empty() ? 0 : 1;
    for (const Eigen::Vector2d& spot : frame.spots)
      ++frames_with_spot[cellOf(spot)];
  }
  std::vector<Frame> moving = frames;
  if (with_spots < kLeastFrames)
    return moving;
  const auto still = [&](const Eigen::Vector2d& spot) {
    // A lamp on the edge of a cell is found in its neighbours.
    const Cell cell = cellOf(spot);
    std::size_t count = 0;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        const auto found = frames_with_spot.find({cell.first + x, cell.second + y});
        count += found == frames_with_spot.end() ? 0 : found->second;
      }
    }
    return static_cast<double>(count) > kLampShare * static_cast<double>(with_spots);
  };
  for (Frame& frame : moving)
    frame.spots.erase(std::remove_if(frame.spots.begin(), frame.spots.end(), still),
                      frame.spots.end());
  return moving;
}

}  // namespace wiimote_tracker::wave
