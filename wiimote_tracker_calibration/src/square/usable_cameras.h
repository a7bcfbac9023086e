#pragma once

#include "wiimote_tracker_calibration/square/sightings.h"

#include <string>
#include <vector>

namespace wiimote_tracker::square {

/// The warning of clockwise corners.
constexpr const char* kZDown =
    "z points down, because the corners were captured clockwise seen from above; capture them "
    "counter-clockwise to get z up";

/// The cameras that saw enough of the corners, and the direction of the corners.
struct UsableCameras {
  std::vector<CameraSightings> cameras;
  bool z_up = true;  ///< The corners go round counter-clockwise seen from above.
  std::vector<std::string> warnings;
};

/// Leaves out cameras that miss corners (with a warning), unless they saw three of them and know
/// gravity, and checks the order of the corners in every image, assuming that all cameras are
/// above the floor.
/// @throws SquareError as solveSquare().
UsableCameras usableCameras(const std::vector<CameraSightings>& cameras);

/// "a", "a and b", "a, b and c".
std::string listOf(const std::vector<std::string>& words);

}  // namespace wiimote_tracker::square
