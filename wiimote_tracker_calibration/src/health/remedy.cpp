#include "health/remedy.h"

#include <algorithm>
#include <cstddef>

namespace wiimote_tracker::health {

namespace {

constexpr char kAllAgain[] = "calibrate all cameras again";

/// Whether a camera can be solved against so many of the rig, as recalibrate::recalibrateCamera()
/// needs it.
bool canSolveAgainst(std::size_t others, const geometry::Rig& rig) {
  return others >= 2 && rig.ray_model == geometry::RayModel::kCalibrated &&
         std::none_of(rig.cameras.begin(), rig.cameras.end(), [](const auto& camera) {
           return camera.time_offset_rule == geometry::TimeOffsetRule::kNone;
         });
}

}  // namespace

bool isCorrectable(const geometry::Rig& rig) {
  return canSolveAgainst(rig.cameras.size() - 1, rig);
}

std::string addCamera(const geometry::Rig& rig, const std::string& name) {
  return canSolveAgainst(rig.cameras.size(), rig) ? "add it (r " + name + " in calibrate)"
                                                  : std::string(kAllAgain) + ", with a waved LED";
}

std::string calibrateAgain(const geometry::Rig& rig) {
  return isCorrectable(rig) ? "recalibrate it (r in calibrate)" : kAllAgain;
}

std::string putBack(const geometry::Rig& rig, bool is_known) {
  return (is_known ? "put it back, or " : "see which was moved, put it back, or ") +
         calibrateAgain(rig);
}

}  // namespace wiimote_tracker::health
