#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_JOIN_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_JOIN_SERVICES_H

#include "node_context.h"

#include <wiimote_tracker_msgs/JoinRig.h>

namespace wiimote_tracker {

/// Two rooms in one world: join.
class JoinServices {
 public:
  explicit JoinServices(NodeContext* context);

 private:
  bool join(wiimote_tracker_msgs::JoinRig::Request& request,
            wiimote_tracker_msgs::JoinRig::Response& response);

  NodeContext& context_;
  ros::ServiceServer service_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_JOIN_SERVICES_H
