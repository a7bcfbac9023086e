#include "gestures.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "gestures");
  if (!ros::master::check()) {
    ROS_FATAL("No ROS master at %s: start roscore, or use roslaunch.",
              ros::master::getURI().c_str());
    return 1;
  }
  // Lives longer than the catch block: with the last handle ROS shuts down and prints no more.
  const ros::NodeHandle nh;
  try {
    wiimote_tracker::Gestures gestures(nh, ros::NodeHandle("~"));
    ros::spin();
  } catch (const wiimote_tracker::ParameterError& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  } catch (const wiimote_tracker::geometry::Error& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  }
  return 0;
}
