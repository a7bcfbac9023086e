#pragma once

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

/// Regions of the image to ignore, by the name of the camera.
using Masks = std::map<std::string, std::vector<geometry::ImageMask>>;

/// Those of a rig's cameras.
inline Masks masksOf(const geometry::Rig& rig) {
  Masks masks;
  for (const geometry::RigCamera& camera : rig.cameras)
    masks[camera.camera.name] = camera.masks;
  return masks;
}

/// The rig with these masks, cameras that are not named with none. Masks move no point: a
/// correction of the volume stays valid.
inline geometry::Rig withMasks(geometry::Rig rig, const Masks& masks) {
  const std::string id = rig.id();
  for (geometry::RigCamera& camera : rig.cameras) {
    const auto found = masks.find(camera.camera.name);
    camera.masks = found != masks.end() ? found->second : std::vector<geometry::ImageMask>();
  }
  if (rig.remap && rig.remap->rig_id == id)
    rig.remap->rig_id = rig.id();
  return rig;
}

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
