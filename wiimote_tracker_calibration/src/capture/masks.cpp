#include "capture/masks.h"

#include <algorithm>

namespace wiimote_tracker::capture {

void applyMasks(const Masks& masks, Image* image) {
  const auto found = masks.find(image->camera);
  if (found == masks.end())
    return;
  const auto first = std::stable_partition(
      image->spots.begin(), image->spots.end(),
      [&](const Eigen::Vector2d& spot) { return !geometry::isMasked(found->second, spot); });
  image->masked.insert(image->masked.end(), first, image->spots.end());
  image->spots.erase(first, image->spots.end());
}

}  // namespace wiimote_tracker::capture
