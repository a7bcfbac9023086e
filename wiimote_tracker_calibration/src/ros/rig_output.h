#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_OUTPUT_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_OUTPUT_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>

namespace wiimote_tracker {

/// Tells the others about a rig: latched calibration/rig, and /tf_static of all its cameras.
class RigOutput {
 public:
  explicit RigOutput(ros::NodeHandle nh);

  void publish(const geometry::Rig& rig);

 private:
  ros::Publisher publisher_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_OUTPUT_H
