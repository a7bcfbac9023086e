#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_RIG_YAML_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_RIG_YAML_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <array>
#include <string>

namespace wiimote_tracker::geometry {

// What the reader and the writer of rig.yaml share.
constexpr const char* kRigFormat = "wiimote_tracker_rig";
constexpr int kRigFormatVersion = 1;

// In the order of the enumerations.
constexpr std::array<const char*, 2> kRayModelWords = {"calibrated", "image_center"};
constexpr std::array<const char*, 3> kTimeOffsetRuleWords = {"none", "always", "one_epoch"};

/// YAML text of a rig. The rig must be valid (Rig::check).
std::string yamlFromRig(const Rig& rig);

/// `where`: the file, for the messages. @throws FileError, InvalidRigError.
Rig rigFromYaml(const std::string& text, const std::string& where);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_RIG_YAML_H
