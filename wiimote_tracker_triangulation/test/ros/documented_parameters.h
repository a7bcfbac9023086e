#ifndef WIIMOTE_TRACKER_TRIANGULATION_TEST_ROS_DOCUMENTED_PARAMETERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_TEST_ROS_DOCUMENTED_PARAMETERS_H

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <string>

namespace wiimote_tracker {

/// Expects that a YAML file in config/ lists the parameters that `reader` has read, and no other
/// ones, with their defaults; each below a comment, which for a number holds its unit in brackets
/// and its range, such as "[px], 0.001 to 100". A bound may also be the name of a parameter beside
/// it. Keys without a comment of their own share that of the key above.
void expectDocumented(const ParameterReader& reader, const std::string& path);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TEST_ROS_DOCUMENTED_PARAMETERS_H
