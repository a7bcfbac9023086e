#include "capture/masks.h"

#include <algorithm>

namespace wiimote_tracker::capture {

bool isMasked(const std::vector<geometry::ImageMask>& masks, const Eigen::Vector2d& pixel) {
  return std::any_of(masks.begin(), masks.end(), [&](const geometry::ImageMask& mask) {
    return (pixel - mask.center).norm() <= mask.radius;
  });
}

void applyMasks(const Masks& masks, Image* image) {
  const auto found = masks.find(image->camera);
  if (found == masks.end())
    return;
  const auto first = std::stable_partition(
      image->spots.begin(), image->spots.end(),
      [&](const Eigen::Vector2d& spot) { return !isMasked(found->second, spot); });
  image->masked.insert(image->masked.end(), first, image->spots.end());
  image->spots.erase(first, image->spots.end());
}

}  // namespace wiimote_tracker::capture
