#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_EXAMPLES_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_EXAMPLES_FILE_H

#include "gesture/recognizer.h"

#include <string>
#include <vector>

namespace wiimote_tracker::gesture {

/// The examples of a YAML file (format wiimote_tracker_gestures, version 1). Strict: keys that are
/// missing or unknown, foreign formats and versions are refused by name.
/// @throws geometry::Error.
std::vector<Example> readExamples(const std::string& file);

/// Written atomically; what was there before is kept as file + ".bak". Numbers come back bit for
/// bit. @throws geometry::Error.
void writeExamples(const std::string& file, const std::vector<Example>& examples);

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_EXAMPLES_FILE_H
