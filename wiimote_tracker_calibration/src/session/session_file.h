#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_FILE_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_FILE_H

#include "session/session.h"

#include <string>

namespace wiimote_tracker::session {

/// Writes a samples file (doc/session.md). As with writeRigFile(), a reader never sees half a file,
/// the old file is kept as path + ".bak", and folders are created.
/// @throws Error: readSessionFile() would refuse it.
/// geometry::FileError: cannot be written; then the old file is as it was.
void writeSessionFile(const Session& session, const std::string& path);

/// Numbers are read bit for bit as they were written.
/// @throws Error: missing, unreadable, cut off, damaged, foreign, of an unknown version, or with
/// values out of range; names the file and the key or line.
Session readSessionFile(const std::string& path);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_FILE_H
