#include "simulated_rig.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/run_node.h>

#include <sys/stat.h>
#include <unistd.h>

#include <string>

namespace {

void simulate(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh) {
  wiimote_tracker::ParameterReader parameters(private_nh);
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
}

}  // namespace

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "simulated_rig", simulate);
}
