#pragma once

#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// Result of decoding the last cycle.
struct BoardReading {
  std::optional<BoardView> view;  ///< Nothing: message says why.
  std::string message;            ///< In words.
};

/// Identifies the LED of each spot from one cycle (board_sequence.h) during which the board was
/// held still. It estimates the phase, accepts any rotation of the camera, missing images and LEDs
/// out of view, and ignores lights that do not follow the sequence.
class BoardDecoder {
 public:
  /// @param minimum_leds that a view must have [4 to 16].
  explicit BoardDecoder(int minimum_leds = 8) : minimum_leds_(minimum_leds) {}

  /// One image, also an empty one. Time [s] is that of the exposure. Images are sorted; a
  /// time that jumps backwards by more than 0.1 s clears all earlier images.
  /// Spots [px] that are not finite are ignored.
  void add(double time, const std::vector<Eigen::Vector2d>& spots);

  /// Removes all images: the next view takes a whole new cycle.
  void clear() { frames_.clear(); }

  /// Decodes the last cycle in about a millisecond; a few times per second is enough.
  BoardReading read() const;

 private:
  struct Frame {
    double time;
    std::vector<Eigen::Vector2d> spots;
  };

  std::string whyNotReady() const;

  int minimum_leds_;
  std::deque<Frame> frames_;  // of one cycle
};

}  // namespace wiimote_tracker::intrinsics
