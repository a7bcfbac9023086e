#include "fusion/frame.h"

#include "association/assign_spots.h"

#include <algorithm>

namespace wiimote_tracker::fusion {

void followSpots(const Frame& before, double maximum_speed, Frame* frame) {
  constexpr double kOtherSlot = 3.0 * 3.0;  // cost of a changed slot [px^2]
  const double elapsed = frame->time - before.time;
  const double gate_squared = maximum_speed * maximum_speed * elapsed * elapsed;
  association::SpotCosts costs;
  // A pair costs at most as much as two unassigned spots.
  costs.reset(std::min(frame->spots.size(), association::kMaximumSpots),
              std::min(before.spots.size(), association::kMaximumSpots),
              0.5 * (gate_squared + kOtherSlot), 0.5 * (gate_squared + kOtherSlot));
  for (std::size_t i = 0; i < costs.spots; ++i) {
    const FrameSpot& spot = frame->spots[i];
    for (std::size_t j = 0; j < costs.tracks; ++j) {
      const FrameSpot& old = before.spots[j];
      const Eigen::Vector2d predicted = old.pixel + elapsed * old.velocity;
      const double distance_squared = (spot.pixel - predicted).squaredNorm();
      if (distance_squared <= gate_squared)
        costs.pair[i][j] = distance_squared + (spot.slot == old.slot ? 0.0 : kOtherSlot);
    }
  }
  const auto track_of_spot = association::assignSpots(costs);
  for (std::size_t i = 0; i < frame->spots.size(); ++i) {
    FrameSpot& spot = frame->spots[i];
    spot.before = kNoSpot;
    spot.velocity.setZero();
    if (i >= costs.spots || track_of_spot[i] == association::kFalseDetection)
      continue;
    spot.before = track_of_spot[i];
    const FrameSpot& old = before.spots[static_cast<std::size_t>(spot.before)];
    spot.velocity = (spot.pixel - old.pixel) / elapsed;
  }
}

}  // namespace wiimote_tracker::fusion
