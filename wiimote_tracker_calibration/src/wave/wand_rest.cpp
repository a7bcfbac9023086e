#include "wand_rest.h"

#include <utility>

namespace wiimote_tracker::wave {

namespace {

// A spot at rest stays within this of where it was first seen [px], but for glitches of this
// duration [s].
constexpr double kRestReach = 3.0;
constexpr double kGlitch = 0.1;
// A hand does not hold both ends still for so long [s].
constexpr double kRest = 2.0;
// Fewest images whose mean is a place.
constexpr std::size_t kRestImages = 30;

}  // namespace

bool WandRest::isFound() const {
  return end_ - begin_ >= kRest && images_ >= kRestImages;
}

void WandRest::add(const Frame& frame) {
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

std::optional<WandSpots> WandRest::spots() const {
  if (!isFound())
    return std::nullopt;
  const auto count = static_cast<double>(images_);
  return WandSpots{sum_[0] / count, sum_[1] / count};
}

}  // namespace wiimote_tracker::wave
