#ifndef WIIMOTE_TRACKER_MSGS_RUN_NODE_H
#define WIIMOTE_TRACKER_MSGS_RUN_NODE_H

#include <ros/ros.h>

#include <exception>
#include <string>

namespace wiimote_tracker {

/// A node's main(): calls node(nh, private_nh), which returns when the node is to end. Without a
/// master, or when an exception comes, it says so in one sentence. @returns the exit status.
template <typename Node>
int runNode(int argc, char** argv, const std::string& name, const Node& node) {
  // Without a timeout init() waits forever for a master to set the parameters of the command line.
  ros::master::setRetryTimeout(ros::WallDuration(1.0));
  ros::init(argc, argv, name);
  ros::master::setRetryTimeout(ros::WallDuration(0.0));
  if (!ros::master::check()) {
    ROS_FATAL("There is no ROS master at %s: start roscore, or use roslaunch.",
              ros::master::getURI().c_str());
    return 1;
  }
  // Lives longer than the catch block: with the last handle ROS shuts down and prints no more.
  const ros::NodeHandle nh;
  try {
    node(nh, ros::NodeHandle("~"));
    return 0;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  }
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_MSGS_RUN_NODE_H
