#pragma once

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture {

/// Reads a path from a CSV file with rows `x y z t_ms`, separated by blanks or commas; lines before
/// the first numeric row are skipped. Positions keep the file's unit; times [s] are relative to the
/// first row. @throws Error naming the file and the wrong line.
Path readPath(const std::string& file);

/// Reads the rows of such a file, each with `columns` or more numbers. @throws Error.
std::vector<std::vector<double>> readRows(const std::string& file, std::size_t columns);

}  // namespace wiimote_tracker::gesture
