#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <cstdint>
#include <vector>

namespace wiimote_tracker {

constexpr double kDelay = 0.002;  // from exposure to arrival [s]

/// A camera's image at a time [s] of those LEDs that are in its view. @param leds world [m]
inline wiimote_tracker_msgs::IrBlobArray blobImage(const geometry::Camera& camera,
                                                   double time,
                                                   const std::vector<Eigen::Vector3d>& leds) {
  wiimote_tracker_msgs::IrBlobArray image;
  image.header.stamp.fromSec(time);
  image.camera = camera.name;
  image.identity = camera.identity;
  image.arrival.fromSec(time + kDelay);
  image.width = static_cast<std::uint32_t>(camera.intrinsics.width);
  image.height = static_cast<std::uint32_t>(camera.intrinsics.height);
  image.max_blobs = 4;
  for (const Eigen::Vector3d& led : leds) {
    const auto pixel = camera.project(led);
    if (!pixel)
      continue;
    image.blobs.emplace_back();
    image.blobs.back().x = pixel->x();
    image.blobs.back().y = pixel->y();
  }
  return image;
}

}  // namespace wiimote_tracker
