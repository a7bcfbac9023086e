#pragma once

#include "gesture/recognizer.h"

#include <string>
#include <vector>

namespace wiimote_tracker::gesture {

/// Reads examples from a YAML file (format wiimote_tracker_gestures, version 1). Missing or unknown
/// keys and other formats or versions are refused by name.
/// @throws FileError.
std::vector<Example> readExamples(const std::string& file);

/// Writes atomically; keeps an existing file as file + ".bak". Numbers are read back bit by bit.
/// @throws FileError.
void writeExamples(const std::string& file, const std::vector<Example>& examples);

}  // namespace wiimote_tracker::gesture
