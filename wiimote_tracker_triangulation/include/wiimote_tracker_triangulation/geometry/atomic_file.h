#pragma once

#include <cstddef>
#include <string>

namespace wiimote_tracker::geometry {

/// Writes a file atomically: for every reader, and after a crash, it has its old content or all of
/// the new. The old file is kept as path + ".bak". Creates folders; follows a link. Threads may
/// write together. @throws FileError, also instead of replacing a bag, or a file whose key `format`
/// is another; then the file at `path` is unchanged.
void writeFileAtomically(const std::string& path, const std::string& content);

constexpr std::size_t kLargestReadable = 32000000;  ///< File [bytes].

/// @param largest size [bytes] that is read.
/// @throws FileError: missing, unreadable, larger, or no regular file.
std::string readFile(const std::string& path, std::size_t largest = kLargestReadable);

}  // namespace wiimote_tracker::geometry
