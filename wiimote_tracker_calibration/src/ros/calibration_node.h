#pragma once

#include "node_parts.h"

#include <ros/node_handle.h>

#include <vector>

namespace wiimote_tracker {

/// The calibration node: what its parts share, and one part per subject. Spin it with several
/// threads: services wait for images.
class CalibrationNode {
 public:
  CalibrationNode(const ros::NodeHandle& nh, const Parameters& parameters);
  ~CalibrationNode();

  NodeContext& context() { return context_; }

 private:
  void endRecordingOfOtherTime(const Lock& lock);

  NodeContext context_;
  InputQueue one_led_inputs_;
  double time_ = 0.0;  // at the last status [s]; only for its timer
  std::vector<NodePart> parts_;
  ros::WallTimer status_timer_;
};

}  // namespace wiimote_tracker
