#pragma once

#include "body/constellation.h"

#include <string>
#include <vector>

namespace wiimote_tracker::body {

/// Reads bodies from a YAML file (format wiimote_tracker_bodies, version 1). Missing or unknown
/// keys and other formats or versions are refused by name. A file that contains only
/// `marker_positions`, a list of {x, y, z} as in rpg_monocular_pose_estimator, is one body named
/// after the file.
/// @throws FileError; Error (Constellation::check).
std::vector<Constellation> readBodies(const std::string& file);

/// Writes atomically; keeps an existing file as file + ".bak". Numbers are read back bit by bit.
/// @throws FileError.
void writeBodies(const std::string& file, const std::vector<Constellation>& bodies);

}  // namespace wiimote_tracker::body
