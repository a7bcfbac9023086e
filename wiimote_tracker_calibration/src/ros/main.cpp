#include "calibration_node.h"

#include <ros/ros.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "calibration");
  if (!ros::master::check()) {
    ROS_FATAL_STREAM("there is no ROS master at " << ros::master::getURI()
                                                  << ": start roscore or use roslaunch");
    return 1;
  }
  // The last handle to go closes the console: these outlive the error message.
  const ros::NodeHandle nh;
  const ros::NodeHandle private_nh("~");
  try {
    wiimote_tracker::CalibrationNode node(
        nh, wiimote_tracker::readParameters(wiimote_tracker::ParameterReader(private_nh)));
    // Services take their time, and cancel must get through meanwhile.
    ros::MultiThreadedSpinner spinner(8);
    spinner.spin();
  } catch (const wiimote_tracker::ParameterError& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
