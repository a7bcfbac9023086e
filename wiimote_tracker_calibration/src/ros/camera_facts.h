#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_FACTS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_FACTS_H

#include "node_context.h"

#include <map>
#include <string>

namespace wiimote_tracker {

/// What is known of the cameras of this run besides what they saw: identity, starting intrinsics,
/// gravity. Fails with a sentence when starting intrinsics are for another size of image.
workflow::Reply collectFacts(NodeContext* context,
                             const Lock& lock,
                             std::map<std::string, workflow::CameraFacts>* facts);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_FACTS_H
