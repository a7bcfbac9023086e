#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LABEL_PLACES_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LABEL_PLACES_H

#include "led_labels.h"

#include <chrono>
#include <string>

namespace wiimote_tracker {

/// The file that the parameter names: in a folder, which ends in a slash, that of the tracker's
/// namespace.
std::string placesFile(const std::string& parameter, const std::string& name_space);

/// Keeps where labelled LEDs are for a node that is started right after this one was killed. The
/// file need not survive a power failure, so the disk is not waited for.
/// @returns whether it was written.
bool writePlaces(const std::string& file, const LedLabels::Places& places);

/// Reads such a file; nothing if there is none, or it is older than this or damaged. The places are
/// older by the file's age.
LedLabels::Places readPlaces(const std::string& file, std::chrono::seconds oldest);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LABEL_PLACES_H
