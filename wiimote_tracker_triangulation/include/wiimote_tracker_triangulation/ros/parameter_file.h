#pragma once

#include <wiimote_tracker_msgs/parameter_tree.h>

#include <string>

namespace wiimote_tracker {

/// The parameters in a YAML file such as config/triangulation.yaml, with the types of the parameter
/// server; for programs without a master. Nothing for an empty path.
/// @param node_name where the file has groups by node, as one for `parameters:=` of launch files,
/// only this node's is read; what no node reads is said on stderr.
/// @throws ParameterError with the file, and the line if there is one.
ParameterTree readParameterTree(const std::string& path, const std::string& node_name);

}  // namespace wiimote_tracker
