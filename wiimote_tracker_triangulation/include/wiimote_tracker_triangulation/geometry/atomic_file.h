#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ATOMIC_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ATOMIC_FILE_H

#include <string>

namespace wiimote_tracker::geometry {

/// Writes a file such that a reader, or a crash, meets the old content or the new one, never a mix;
/// what was there before is kept as path + ".bak". Creates folders; follows a symbolic link.
/// @throws FileError; then the file at `path` is as it was.
void writeFileAtomically(const std::string& path, const std::string& content);

/// @throws FileError: missing or unreadable.
std::string readFile(const std::string& path);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_ATOMIC_FILE_H
