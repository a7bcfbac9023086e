#include "simulated_rig.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <wiimote_tracker_msgs/text.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <thread>

namespace {

using wiimote_tracker::simulation::Description;
using wiimote_tracker::simulation::SimulatedRig;

constexpr char kPurpose[] =
    "Simulates Wii Remotes and LEDs in real time.\n"
    "\n"
    "Private parameters:\n"
    "  description       a rig description such as simulation/paper_rig.yaml (needed)\n"
    "  socket_directory  folder for the sockets <camera>.sock, made if absent\n"
    "                    (default: /tmp/wiimote_tracker_simulation_$USER)";

// For a simulation of the same name to end, as the master told it when this one registered.
constexpr std::chrono::seconds kPatience(20);

/// @throws std::system_error: another simulation keeps the sockets.
std::unique_ptr<SimulatedRig> makeRig(const ros::NodeHandle& nh,
                                      const Description& description,
                                      const std::string& directory) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    // If this fails, the first socket reports why.
    const bool there = mkdir(directory.c_str(), 0700) == 0 || errno == EEXIST;
    try {
      return std::make_unique<SimulatedRig>(nh, description, directory);
    } catch (const std::system_error& error) {
      // The simulation before removes its folder at its end.
      const bool in_use = error.code().value() == EADDRINUSE;
      const bool passes = in_use || (there && error.code().value() == ENOENT);
      if (!passes || !ros::ok() || std::chrono::steady_clock::now() > deadline)
        throw;
      if (in_use)
        ROS_WARN_ONCE(
            "The sockets in %s are in use: waiting for another simulation to end. To have both, "
            "give this one a socket_directory of its own.",
            directory.c_str());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

void simulate(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh) {
  wiimote_tracker::ParameterReader parameters(private_nh);
  const auto path = parameters.required<std::string>(
      "description", "the path of a rig description such as simulation/paper_rig.yaml");
  const char* const user = std::getenv("USER");
  const auto directory = parameters.optional<std::string>(
      "socket_directory",
      std::string("/tmp/wiimote_tracker_simulation_") + (user != nullptr ? user : ""));
  if (directory.empty())
    throw wiimote_tracker::ParameterError(parameters.nameOf("socket_directory") +
                                          " is empty: name a folder for the sockets");
  parameters.refuseUnknown();
  const auto description = wiimote_tracker::simulation::readDescription(path);

  {
    const std::unique_ptr<SimulatedRig> rig = makeRig(nh, description, directory);
    ROS_INFO_STREAM(
        "Simulating " << wiimote_tracker::counted(description.cameras.size(), "virtual Wii Remote")
                      << " in " << directory);
    ros::AsyncSpinner spinner(1);
    spinner.start();
    rig->run();
  }
  rmdir(directory.c_str());  // fails if it contains anything else
}

}  // namespace

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "simulated_rig", kPurpose, simulate);
}
