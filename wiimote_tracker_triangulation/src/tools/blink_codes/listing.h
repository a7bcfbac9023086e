#pragma once

#include "wiimote_tracker_triangulation/identity/blink_codes.h"

#include <string>
#include <vector>

namespace wiimote_tracker::blink_codes_tool {

/// On and off times of each LED in a period of this length [s], as a table.
std::string table(const identity::BlinkCodes& codes, double period);

/// An Arduino sketch that blinks all LEDs, one pin each, with a period of this length [s].
std::string sketch(const identity::BlinkCodes& codes, double period);

/// Properties of valid codes: their least difference, the longest dark time, and what cameras at
/// 100 images per second may miss.
std::string remarks(const identity::BlinkCodes& codes);

/// A file of cyclic codes for these labels, for readBlinkCodes. @throws Error.
std::string cyclicFile(const std::vector<std::string>& labels, double chip, double tolerance);

}  // namespace wiimote_tracker::blink_codes_tool
