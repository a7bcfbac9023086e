#pragma once

#include "evaluate.h"

#include <optional>
#include <string>

namespace wiimote_tracker::gesture_tool {

/// A text.
std::string table(const Evaluation& evaluation, const std::optional<FalseAlarms>& alarms);

/// JSON: accuracy [0..1], gestures, confusion [drawn][recognised], and the rest. @throws
/// geometry::Error.
void writeJson(const std::string& file,
               const Evaluation& evaluation,
               const std::optional<FalseAlarms>& alarms);

}  // namespace wiimote_tracker::gesture_tool
