#pragma once

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <string>
#include <vector>

namespace wiimote_tracker::gesture_tool {

/// One gesture, as a person drew it.
struct Sample {
  std::string gesture;  ///< The file's name without .csv.
  gesture::Path path;   ///< In the file's unit of length.
};

struct Person {
  std::string folder;  ///< Its path, without symbolic links.
  std::vector<Sample> samples;
};

/// A folder per person, in it a CSV per gesture (see gesture::readPath). In the order of the names.
/// @throws Error naming the file and line, or the folder that is empty.
std::vector<Person> readPeople(const std::string& folder);

}  // namespace wiimote_tracker::gesture_tool
