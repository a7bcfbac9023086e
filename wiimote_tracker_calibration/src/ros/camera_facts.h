#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_FACTS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_FACTS_H

#include "wiimote_tracker_calibration/workflow/calibration.h"

#include "camera_inputs.h"
#include "parameters.h"

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// What is known of cameras besides what they saw: identity, starting intrinsics, gravity. Fails
/// with a sentence when starting intrinsics are for another size of image.
workflow::Reply collectFacts(const std::vector<std::string>& names,
                             const std::map<std::string, CameraInput>& inputs,
                             const Parameters& parameters,
                             std::map<std::string, workflow::CameraFacts>* facts);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_FACTS_H
