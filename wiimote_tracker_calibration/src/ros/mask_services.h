#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_MASK_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_MASK_SERVICES_H

#include "capture/mask_learner.h"

#include "node_context.h"

#include <wiimote_tracker_msgs/LearnMasks.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Lights that are not the LED: learn_masks, clear_masks.
class MaskServices {
 public:
  explicit MaskServices(NodeContext* context);

 private:
  workflow::Reply learn(const wiimote_tracker_msgs::LearnMasks::Request& request,
                        wiimote_tracker_msgs::LearnMasks::Response* response);
  workflow::Reply clear();
  workflow::Reply useMasks(const std::map<std::string, capture::LearnedMasks>& learned,
                           const Lock& lock);

  NodeContext& context_;
  std::optional<capture::MaskLearner> learner_;  // while lights are being learned
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_MASK_SERVICES_H
