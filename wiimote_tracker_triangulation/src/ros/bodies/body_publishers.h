#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_PUBLISHERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_PUBLISHERS_H

#include "wiimote_tracker_triangulation/body/constellation.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes all bodies on `bodies`, and for each one its pose on <body>/pose and the transform
/// world -> body.
class BodyPublishers {
 public:
  /// `publish_predicted`: pose and transform of predicted bodies too.
  BodyPublishers(const ros::NodeHandle& nh, bool publish_predicted);

  /// Advertises the topics of these bodies.
  void setBodies(const std::vector<body::Constellation>& bodies);

  void publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies);

 private:
  ros::NodeHandle nh_;
  bool publish_predicted_;
  ros::Publisher all_;
  std::map<std::string, ros::Publisher> publishers_;  // by name
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<geometry_msgs::TransformStamped> transforms_;  // reused
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_PUBLISHERS_H
