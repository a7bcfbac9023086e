#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODIES_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODIES_FILE_H

#include "wiimote_tracker_triangulation/body/constellation.h"

#include <string>
#include <vector>

namespace wiimote_tracker::body {

/// The bodies of a YAML file (format wiimote_tracker_bodies, version 1). Strict: keys that are
/// missing or unknown, foreign formats and versions are refused by name. A file with nothing but
/// `marker_positions`, a list of {x, y, z} as the rpg_monocular_pose_estimator reads it, is one
/// body named after the file.
/// @throws geometry::Error.
std::vector<Constellation> readBodies(const std::string& file);

/// Written atomically; what was there before is kept as file + ".bak". Numbers come back bit for
/// bit. @throws geometry::Error.
void writeBodies(const std::string& file, const std::vector<Constellation>& bodies);

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODIES_FILE_H
