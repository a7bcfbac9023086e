#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>

namespace wiimote_tracker::health {

/// Whether one camera can be solved against the others: two at least, with clocks that a wave told.
bool isCorrectable(const geometry::Rig& rig);

/// How to add a camera that the rig lacks: alone, or else with all cameras.
std::string addCamera(const geometry::Rig& rig, const std::string& name);

/// How to calibrate a camera again: alone, or else with all cameras.
std::string calibrateAgain(const geometry::Rig& rig);

/// What to do about cameras that were moved. @param is_known which ones they are.
std::string putBack(const geometry::Rig& rig, bool is_known);

}  // namespace wiimote_tracker::health
