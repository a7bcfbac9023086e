#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_FILE_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_FILE_H

#include "wiimote_tracker_calibration/session/session.h"

#include <string>

namespace wiimote_tracker::session {

/// Writes all that was captured (layout: doc/session.md) in the way of writeRigFile(): a reader
/// never sees half a file, what was there is kept as path + ".bak", folders are created.
/// @throws SessionError: the session holds what could not be read again (see readSessionFile()).
/// geometry::RigFileError: cannot be written; then the old file is as it was.
void writeSessionFile(const Session& session, const std::string& path);

/// Every number comes back bit for bit as it was written.
/// @throws geometry::RigFileError: missing or unreadable. SessionError: cut off, damaged, foreign,
/// of an unknown version, or with values out of range; names the file and the key or line.
Session readSessionFile(const std::string& path);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_FILE_H
