#include "health/remedy.h"

#include <algorithm>

namespace wiimote_tracker::health {

// As recalibrate::recalibrateCamera() needs it.
bool isCorrectable(const geometry::Rig& rig) {
  return rig.cameras.size() >= 3 && rig.ray_model == geometry::RayModel::kCalibrated &&
         std::none_of(rig.cameras.begin(), rig.cameras.end(), [](const auto& camera) {
           return camera.time_offset_rule == geometry::TimeOffsetRule::kNone;
         });
}

std::string calibrateAgain(const geometry::Rig& rig) {
  return isCorrectable(rig) ? "recalibrate it (r in calibrate)" : "calibrate all cameras again";
}

std::string putBack(const geometry::Rig& rig, bool is_known) {
  return (is_known ? "put it back, or " : "see which was moved, put it back, or ") +
         calibrateAgain(rig);
}

}  // namespace wiimote_tracker::health
