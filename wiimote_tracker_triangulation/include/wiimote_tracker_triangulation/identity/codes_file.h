#pragma once

#include "wiimote_tracker_triangulation/identity/blink_codes.h"

#include <string>

namespace wiimote_tracker::identity {

/// Reads codes from a YAML file (format wiimote_tracker_blink_codes, version 1; see
/// config/blink_codes.yaml and config/blink_codes_paper.yaml). Missing or unknown keys and other
/// formats or versions are refused by name.
/// @throws FileError.
BlinkCodes readBlinkCodes(const std::string& file);

}  // namespace wiimote_tracker::identity
