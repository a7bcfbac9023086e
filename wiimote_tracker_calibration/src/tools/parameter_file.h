#ifndef WIIMOTE_TRACKER_CALIBRATION_TOOLS_PARAMETER_FILE_H
#define WIIMOTE_TRACKER_CALIBRATION_TOOLS_PARAMETER_FILE_H

#include <wiimote_tracker_msgs/parameter_tree.h>

#include <string>

namespace wiimote_tracker {

/// What a YAML file like config/calibration.yaml sets, with the types that the parameter server
/// would give it.
/// @throws ParameterError with the file, and the line if there is one.
ParameterTree readParameterTree(const std::string& path);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_TOOLS_PARAMETER_FILE_H
