#ifndef WIIMOTE_TRACKER_CALIBRATION_CAPTURE_MASKS_H
#define WIIMOTE_TRACKER_CALIBRATION_CAPTURE_MASKS_H

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

/// Regions of the image to ignore, by the name of the camera.
using Masks = std::map<std::string, std::vector<geometry::ImageMask>>;

/// Moves the spots that lie in a region of this image's camera from `spots` to `masked`.
inline void applyMasks(const Masks& masks, Image* image) {
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

#endif  // WIIMOTE_TRACKER_CALIBRATION_CAPTURE_MASKS_H
