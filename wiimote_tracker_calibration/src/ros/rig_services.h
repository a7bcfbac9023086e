#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_SERVICES_H

#include "node_context.h"

#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/SaveRig.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The rig's file: save, load.
class RigServices {
 public:
  /// Loads and publishes the last saved rig, if there is one.
  explicit RigServices(NodeContext* context);

 private:
  bool save(wiimote_tracker_msgs::SaveRig::Request& request,
            wiimote_tracker_msgs::SaveRig::Response& response);
  bool load(wiimote_tracker_msgs::LoadRig::Request& request,
            wiimote_tracker_msgs::LoadRig::Response& response);
  workflow::Reply loadFile(const std::string& path);
  std::string pathOr(const std::string& path);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_SERVICES_H
