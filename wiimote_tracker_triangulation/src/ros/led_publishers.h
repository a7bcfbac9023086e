#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_PUBLISHERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_PUBLISHERS_H

#include "tracker/parameters.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <future>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes each LED by itself: its point on <label>/point, the transform world -> label, and,
/// where asked, <label>/odometry. The topics of listed labels exist from the start, those of other
/// LEDs from their first point until they are lost or get a listed label. Those are advertised in
/// another thread, one LED after the other: while there is no ROS master, advertising waits for it.
class LedPublishers {
 public:
  LedPublishers(const ros::NodeHandle& nh,
                const std::vector<std::string>& labels,
                const OutputOptions& options);

  void publish(const wiimote_tracker_msgs::TrackedPointArray& points);

 private:
  struct Topics {
    ros::Publisher point;
    ros::Publisher odometry;  // none: not asked for
  };

  static Topics advertise(ros::NodeHandle nh, const std::string& label, bool with_odometry);
  const Topics* topicsOf(const std::string& label);
  void removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points);

  ros::NodeHandle nh_;
  std::set<std::string> listed_;
  OutputOptions options_;
  std::map<std::string, Topics> topics_;  // by label
  std::string advertising_label_;
  std::future<Topics> advertising_;  // invalid: none are being advertised
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<geometry_msgs::TransformStamped> transforms_;  // reused
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_PUBLISHERS_H
