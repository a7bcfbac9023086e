#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_PARAMETER_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_PARAMETER_FILE_H

#include "parameters.h"

#include <string>

namespace wiimote_tracker {

/// The node's parameters from a YAML file such as config/triangulation.yaml.
/// @param path empty: the defaults.
/// @param mode instead of the file's; empty: the file's.
/// @throws ParameterError: unreadable, or what the node would refuse.
TrackingParameters readParameterFile(const std::string& path, const std::string& mode);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_PARAMETER_FILE_H
