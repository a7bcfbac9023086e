#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_JOIN_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_JOIN_SERVICES_H

#include "node_context.h"
#include "wiimote_tracker_calibration/session/join_rigs.h"

#include <wiimote_tracker_msgs/JoinRig.h>

#include <vector>

namespace wiimote_tracker {

/// Two rooms in one world: join. Over the cameras that both have; without any, over the known
/// places, which are then places of the first world.
class JoinServices {
 public:
  explicit JoinServices(NodeContext* context);

 private:
  bool join(wiimote_tracker_msgs::JoinRig::Request& request,
            wiimote_tracker_msgs::JoinRig::Response& response);
  /// The known places that were measured with the current rig.
  std::vector<session::CommonPlace> commonPlaces(const Lock& lock);

  NodeContext& context_;
  ros::ServiceServer service_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_JOIN_SERVICES_H
