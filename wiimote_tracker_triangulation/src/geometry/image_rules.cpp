#include "geometry/image_rules.h"

#include <algorithm>

namespace wiimote_tracker::geometry {

double timeOffset(const RigCamera& camera, std::uint32_t clock_epoch) {
  switch (camera.time_offset_rule) {
    case TimeOffsetRule::kAlways:
      return camera.time_offset;
    case TimeOffsetRule::kOneEpoch:
      return clock_epoch == camera.time_offset_epoch ? camera.time_offset : 0.0;
    case TimeOffsetRule::kNone:
      break;
  }
  return 0.0;
}

bool isTimeOffsetKnown(const RigCamera& camera, std::uint32_t clock_epoch) {
  return camera.time_offset_rule != TimeOffsetRule::kOneEpoch ||
         clock_epoch == camera.time_offset_epoch;
}

bool isMasked(const RigCamera& camera, const Eigen::Vector2d& pixel) {
  return std::any_of(camera.masks.begin(), camera.masks.end(), [&](const ImageMask& mask) {
    return (pixel - mask.center).norm() <= mask.radius;
  });
}

}  // namespace wiimote_tracker::geometry
