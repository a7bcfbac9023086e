#pragma once

#include <array>

namespace wiimote_tracker::geometry {

// What the reader and the writer of rig.yaml share.
constexpr const char* kRigFormat = "wiimote_tracker_rig";
constexpr int kRigFormatVersion = 1;

// In the order of the enumerations.
constexpr std::array<const char*, 2> kRayModelWords = {"calibrated", "image_center"};
constexpr std::array<const char*, 3> kTimeOffsetRuleWords = {"none", "always", "one_epoch"};

}  // namespace wiimote_tracker::geometry
