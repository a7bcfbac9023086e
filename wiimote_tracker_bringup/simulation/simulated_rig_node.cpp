#include "simulated_rig.h"

#include <ros/ros.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <sys/stat.h>
#include <unistd.h>

#include <string>

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulated_rig");
  if (!ros::master::check()) {
    ROS_FATAL_STREAM("there is no ROS master at " << ros::master::getURI()
                                                  << ": start roscore or use roslaunch");
    return 1;
  }
  // Lives longer than the catch block: with the last handle ROS shuts down and prints no more.
  ros::NodeHandle nh;
  try {
    wiimote_tracker::ParameterReader parameters(ros::NodeHandle("~"));
    const auto path = parameters.required<std::string>(
        "description", "the path of a rig description such as simulation/paper_rig.yaml");
    const auto directory =
        parameters.optional<std::string>("socket_directory", "/tmp/wiimote_tracker_simulation");
    parameters.refuseUnknown();
    const auto description = wiimote_tracker::simulation::readDescription(path);

    mkdir(directory.c_str(), 0700);  // if this fails, the first socket reports why
    {
      wiimote_tracker::simulation::SimulatedRig rig(nh, description, directory);
      ROS_INFO_STREAM("Simulating " << description.cameras.size() << " virtual Wii Remotes in "
                                    << directory);
      ros::AsyncSpinner spinner(1);
      spinner.start();
      rig.run();
    }
    rmdir(directory.c_str());  // fails if it contains anything else
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}
