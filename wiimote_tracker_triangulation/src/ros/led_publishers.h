#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_PUBLISHERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_PUBLISHERS_H

#include <geometry_msgs/PointStamped.h>
#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Publishes each LED by itself: its point on <label>/point, and the transform world -> label. The
/// topics of listed labels are there from the start, those of others while their LEDs are. Topics
/// are made and ended in changeTopics() alone, which asks the master.
class LedPublishers {
 public:
  /// `publish_predicted`: also of LEDs that are hidden.
  LedPublishers(const ros::NodeHandle& nh,
                const std::vector<std::string>& labels,
                bool publish_predicted);

  /// What needs a new topic waits for changeTopics(). @returns whether that has something to do.
  bool publish(const wiimote_tracker_msgs::TrackedPointArray& points);

  /// Makes the topics of new LEDs, and ends those of LEDs that are lost or have got a listed label.
  void changeTopics();

 private:
  void findUnused(const wiimote_tracker_msgs::TrackedPointArray& points);

  ros::NodeHandle nh_;
  std::set<std::string> listed_;
  bool publish_predicted_;
  std::map<std::string, ros::Publisher> publishers_;  // by label
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<geometry_msgs::TransformStamped> transforms_;                   // reused
  std::vector<std::pair<std::string, geometry_msgs::PointStamped>> waiting_;  // by label
  std::vector<std::string> unused_;                                           // labels
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_PUBLISHERS_H
