#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CAMERA_FAULT_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CAMERA_FAULT_H

#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <string>

namespace wiimote_tracker {

/// One sentence that says what is wrong with a camera, and what to do.
std::string describe(const tracking::CameraFault& fault, const std::string& camera);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CAMERA_FAULT_H
