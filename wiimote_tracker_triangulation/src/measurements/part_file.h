#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_PART_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_PART_FILE_H

#include <string>

namespace wiimote_tracker::measurements {

/// The name of a file while it is being written.
std::string partOf(const std::string& path);

/// Creates the folder of the file, and the part, empty. @throws Error.
void createPart(const std::string& path);

/// Brings the part to the disk and gives it its name, in one step for whoever reads; what had the
/// name before is kept as path + ".bak". @throws Error; then the part stays.
void finishPart(const std::string& path);

/// @throws Error that says why, from errno.
[[noreturn]] void failToWrite(const std::string& path, int error);

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_PART_FILE_H
