#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_PUBLISHERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_PUBLISHERS_H

#include "../tracker/parameters.h"
#include "body/constellation.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes all bodies on `bodies`, and for each one its pose on <body>/pose, its twist on
/// <body>/twist, both on <body>/odometry, and, where asked, the transform world -> body.
class BodyPublishers {
 public:
  BodyPublishers(const ros::NodeHandle& nh, const OutputOptions& options);

  /// Advertises the topics of these bodies.
  void setBodies(const std::vector<body::Constellation>& bodies);

  /// @param bridged for each body of the message, whether its topics go on while it is predicted.
  void publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
               const std::vector<bool>& bridged);

 private:
  struct Topics {
    ros::Publisher pose;
    ros::Publisher twist;
    ros::Publisher odometry;
  };

  ros::NodeHandle nh_;
  OutputOptions options_;
  ros::Publisher all_;
  std::map<std::string, Topics> topics_;  // by name
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<geometry_msgs::TransformStamped> transforms_;  // reused
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_PUBLISHERS_H
