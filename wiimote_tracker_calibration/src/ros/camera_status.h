#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_STATUS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_STATUS_H

#include "workflow/next_step.h"

#include "camera_inputs.h"

#include <wiimote_tracker_msgs/CalibrationCameraStatus.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// What each camera shows over the last `window` seconds, and what it has contributed so far.
std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> cameraStatus(
    const workflow::Calibration& calibration,
    const std::map<std::string, CameraInput>& cameras,
    double now,
    double window);

/// Where the calibration stands, without header and cameras. @param verdict of the rig in use.
wiimote_tracker_msgs::CalibrationStatus calibrationStatus(const workflow::Calibration& calibration,
                                                          const samples::Verdict& verdict);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_STATUS_H
