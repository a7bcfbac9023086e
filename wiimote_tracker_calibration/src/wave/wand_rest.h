#pragma once

#include "wiimote_tracker_calibration/wave/recording.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace wiimote_tracker::wave {

/// Where a camera saw the two LEDs of a wand, distorted [px].
using WandSpots = std::array<Eigen::Vector2d, 2>;

/// Finds where one camera saw a wand that lay still: two spots, and no other, within 3 px for 2 s
/// and 30 images. Glitches of up to 0.1 s, and images with another number of spots, do not count.
class WandRest {
 public:
  /// Frames in the order of their stamps.
  void add(const Frame& frame) {
    if (is_over_ || frame.spots.size() != 2)
      return;
    WandSpots spots = {frame.spots[0], frame.spots[1]};
    // A camera reports its spots in any order.
    if (images_ > 0 && (spots[0] - first_[0]).norm() > (spots[1] - first_[0]).norm())
      std::swap(spots[0], spots[1]);
    const bool is_still = images_ > 0 && (spots[0] - first_[0]).norm() <= kRestReach &&
                          (spots[1] - first_[1]).norm() <= kRestReach;
    if (!is_still && images_ > 0 && frame.stamp - end_ <= kGlitch)
      return;
    if (isFound()) {
      is_over_ = !is_still;
      end_ = is_still ? frame.stamp : end_;
      return;
    }
    if (!is_still) {
      first_ = spots;
      sum_ = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
      images_ = 0;
      begin_ = frame.stamp;
    }
    for (std::size_t led = 0; led < 2; ++led)
      sum_[led] += spots[led];
    ++images_;
    end_ = frame.stamp;
  }

  /// Mean spots of the first rest, in any order; nothing until it has lasted long enough.
  std::optional<WandSpots> spots() const {
    if (!isFound())
      return std::nullopt;
    const auto count = static_cast<double>(images_);
    return WandSpots{sum_[0] / count, sum_[1] / count};
  }
  /// Stamp of the last image of that rest [s].
  double end() const { return end_; }

 private:
  // A spot at rest stays within this of where it was first seen [px], but for glitches of this
  // duration [s].
  static constexpr double kRestReach = 3.0;
  static constexpr double kGlitch = 0.1;
  // A hand does not hold both ends still for so long [s].
  static constexpr double kRest = 2.0;
  // Fewest images whose mean is a place.
  static constexpr std::size_t kRestImages = 30;

  bool isFound() const { return end_ - begin_ >= kRest && images_ >= kRestImages; }

  WandSpots first_{};  // of this rest [px]
  WandSpots sum_{};    // of its first seconds [px]
  std::size_t images_ = 0;
  double begin_ = 0.0;  // [s]
  double end_ = 0.0;    // [s]
  bool is_over_ = false;
};

}  // namespace wiimote_tracker::wave
