#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_WAND_REST_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_WAND_REST_H

#include "wiimote_tracker_calibration/wave/recording.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>

namespace wiimote_tracker::wave {

/// Where a camera saw the two LEDs of a wand, distorted [px].
using WandSpots = std::array<Eigen::Vector2d, 2>;

/// Finds where one camera saw a wand that lay still: two spots, and no other, within 3 px for 2 s
/// and 30 images. Glitches of up to 0.1 s, and images with another number of spots, do not count.
class WandRest {
 public:
  /// Frames in the order of their stamps.
  void add(const Frame& frame);

  /// Mean spots of the first rest, in any order; nothing until it has lasted long enough.
  std::optional<WandSpots> spots() const;
  /// Stamp of the last image of that rest [s].
  double end() const { return end_; }

 private:
  bool isFound() const;

  WandSpots first_{};  // of this rest [px]
  WandSpots sum_{};    // of its first seconds [px]
  std::size_t images_ = 0;
  double begin_ = 0.0;  // [s]
  double end_ = 0.0;    // [s]
  bool is_over_ = false;
};

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_WAND_REST_H
