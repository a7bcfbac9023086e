#include "driver.h"

#include <ros/ros.h>

int main(int argc, char** argv) {
  // Parameters on the command line go to the master already in init(), which else waits for ever.
  ros::master::setRetryTimeout(ros::WallDuration(1.0));
  ros::init(argc, argv, "driver");
  ros::master::setRetryTimeout(ros::WallDuration(0.0));
  if (!ros::master::check()) {
    ROS_FATAL("no ROS master answers at %s: start roscore, or correct ROS_MASTER_URI",
              ros::master::getURI().c_str());
    return 1;
  }
  // Outlive the driver: with the last handle ROS would stop, and with it the log.
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
