#ifndef WIIMOTE_TRACKER_TRIANGULATION_ROS_PARAMETER_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_ROS_PARAMETER_FILE_H

#include <wiimote_tracker_msgs/parameter_tree.h>

#include <string>

namespace wiimote_tracker {

/// What a YAML file such as config/triangulation.yaml sets, with the types that the parameter
/// server would give it; for programs without a master. Nothing for an empty path.
/// @throws ParameterError with the file, and the line if there is one.
ParameterTree readParameterTree(const std::string& path);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ROS_PARAMETER_FILE_H
