#include "driver.h"

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "driver");
  if (!ros::master::check()) {
    ROS_FATAL("no ROS master answers at %s: start roscore, or correct ROS_MASTER_URI",
              ros::master::getURI().c_str());
    return 1;
  }
  try {
    const wiimote_tracker::driver::Driver driver(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  }
  return 0;
}
