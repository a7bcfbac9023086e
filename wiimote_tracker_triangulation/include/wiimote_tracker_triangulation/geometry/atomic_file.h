#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ATOMIC_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ATOMIC_FILE_H

#include <string>

namespace wiimote_tracker::geometry {

/// Writes a file atomically: for every reader, and after a crash, it has its old content or all of
/// the new. The old file is kept as path + ".bak". Creates folders; follows a symbolic link.
/// @throws FileError; then the file at `path` is unchanged.
void writeFileAtomically(const std::string& path, const std::string& content);

/// @throws FileError: missing or unreadable.
std::string readFile(const std::string& path);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ATOMIC_FILE_H
