#pragma once

#include "identity/led_labels.h"

#include <chrono>
#include <string>
#include <system_error>

namespace wiimote_tracker::identity {

/// The file that the parameter names: in a folder, which ends in a slash, that of the tracker's
/// namespace.
std::string placesFile(const std::string& parameter, const std::string& name_space);

/// Keeps where labelled LEDs are for a node that is started right after this one was killed. The
/// file need not survive a power failure, so the disk is not waited for.
/// @param rig_id of the rig in whose world the places are.
/// @returns why it was not written, if so.
std::error_code writePlaces(const std::string& file,
                            const std::string& rig_id,
                            const LedLabels::Places& places);

/// Reads such a file; nothing if there is none, or it is of another rig, older than this or
/// damaged. The places are older by the file's age. Older versions wrote no rig.
LedLabels::Places readPlaces(const std::string& file,
                             const std::string& rig_id,
                             std::chrono::seconds oldest);

}  // namespace wiimote_tracker::identity
