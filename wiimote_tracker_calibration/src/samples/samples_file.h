#pragma once

#include "samples/samples.h"

#include <string>

namespace wiimote_tracker::samples {

/// Writes a samples file (doc/samples.md). As with writeRigFile(), a reader never sees half a file,
/// the old file is kept as path + ".bak", and folders are created.
/// @throws Error: readSamplesFile() would refuse it.
/// geometry::FileError: cannot be written; then the old file is as it was.
void writeSamplesFile(const Samples& samples, const std::string& path);

/// Numbers are read bit for bit as they were written.
/// @throws Error: missing, unreadable, cut off, damaged, foreign, of an unknown version, or with
/// values out of range; names the file and the key or line.
Samples readSamplesFile(const std::string& path);

}  // namespace wiimote_tracker::samples
