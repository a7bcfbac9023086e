#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <string>

namespace wiimote_tracker::geometry {

/// Reads a rig.yaml (layout: doc/rig.yaml of this package). Numbers come back bit for bit as
/// written.
/// @throws FileError: missing, unreadable, truncated, foreign, or of an unknown version; names the
/// file, and the key where there is one. InvalidRigError: well-formed but unusable values.
Rig readRigFile(const std::string& path);

/// Writes rig.yaml: to a new file that is then renamed, so that a reader never sees half a file; a
/// file that was there is kept as path + ".bak". Folders are created.
/// @throws FileError: cannot be written, or could not be read again (larger than kLargestReadable,
/// or a name with kUnreadableText); then the old file is as it was. InvalidRigError.
void writeRigFile(const Rig& rig, const std::string& path);

/// Writes a standard camera-info YAML (keys of camera_calibration_parsers) for one camera, in the
/// same atomic way. @throws FileError.
void writeCameraInfoFile(const Camera& camera, const std::string& path);

}  // namespace wiimote_tracker::geometry
