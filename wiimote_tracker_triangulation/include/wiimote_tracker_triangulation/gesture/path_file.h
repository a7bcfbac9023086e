#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_PATH_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_PATH_FILE_H

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture {

/// The path in a CSV: rows `x y z t_ms`, separated by blanks or commas; lines before the first row
/// of numbers are passed over. Positions in whatever unit of length the file has; times [s] from
/// the first row on. @throws Error naming the file, and the line that is wrong.
Path readPath(const std::string& file);

/// Rows of numbers of a file as above, `columns` or more in each. @throws Error.
std::vector<std::vector<double>> readRows(const std::string& file, std::size_t columns);

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_PATH_FILE_H
