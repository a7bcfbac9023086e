#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_FILE_PATHS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_FILE_PATHS_H

#include "parameters.h"

#include <string>

namespace wiimote_tracker {

/// The file of a request, since whoever reaches the master can send one. Links are followed.
/// @param requested absolute, or relative to the node's working folder.
/// @throws Refusal: it is not below Parameters::file_folder, or not UTF-8.
std::string permittedPath(const std::string& requested, const Parameters& parameters);

/// The rig file of a request. @param requested as above; empty: that of the parameter rig_file.
std::string rigPath(const std::string& requested, const Parameters& parameters);

/// The samples of a request. @param requested as above; empty: samples.yaml beside the rig file.
std::string samplesPath(const std::string& requested, const Parameters& parameters);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_FILE_PATHS_H
