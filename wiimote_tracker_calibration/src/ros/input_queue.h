#pragma once

#include "capture/image.h"
#include "requests.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// An image, or a reading of a camera's accelerometer.
struct Input {
  capture::Image image;                           ///< Of a reading: camera and stamp only.
  std::optional<Eigen::Vector3d> specific_force;  ///< In the camera's optical frame [m/s^2].
};

/// What waits for work that takes longer than an image may wait. What a slow computer cannot take
/// in time is left out.
class InputQueue {
 public:
  void add(Input input, const Lock&) {
    if (waiting_.size() < kMostWaiting)
      waiting_.push_back(std::move(input));
  }

  /// What came since the last call.
  std::vector<Input> take(const Lock&) { return std::exchange(waiting_, {}); }

 private:
  static constexpr std::size_t kMostWaiting = 20000;  // Four cameras' images and readings of 25 s.

  std::vector<Input> waiting_;
};

}  // namespace wiimote_tracker
