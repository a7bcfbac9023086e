#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <sensor_msgs/CameraInfo.h>

#include <cstdint>

namespace wiimote_tracker {

/// As a driver publishes the lens. @param lens not a fisheye
inline sensor_msgs::CameraInfo infoOf(const geometry::Intrinsics& lens) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(lens.width);
  info.height = static_cast<std::uint32_t>(lens.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(lens.distortion.begin(), lens.distortion.end());
  info.K[0] = lens.fx;
  info.K[2] = lens.cx;
  info.K[4] = lens.fy;
  info.K[5] = lens.cy;
  return info;
}

}  // namespace wiimote_tracker
