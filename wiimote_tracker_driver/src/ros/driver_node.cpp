#include "driver.h"

#include <ros/ros.h>

int main(int argc, char** argv) {
  // Without a timeout init() waits forever for a master to set the parameters of the command line.
  ros::master::setRetryTimeout(ros::WallDuration(1.0));
  ros::init(argc, argv, "driver");
  ros::master::setRetryTimeout(ros::WallDuration(0.0));
  if (!ros::master::check()) {
    ROS_FATAL("no ROS master answers at %s: start roscore, or correct ROS_MASTER_URI",
              ros::master::getURI().c_str());
    return 1;
  }
  // These outlive the driver, because ROS and its log stop with the last handle.
  const ros::NodeHandle nh;
  const ros::NodeHandle private_nh("~");
  try {
    const wiimote_tracker::driver::Driver driver(nh, private_nh);
    ros::spin();
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  }
  return 0;
}
