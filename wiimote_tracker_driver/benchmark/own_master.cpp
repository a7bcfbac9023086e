#include "own_master.h"

#include <ros/ros.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

namespace wiimote_tracker {
namespace {

constexpr double kMasterLimit = 60.0;  // [s]

int freePort() {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  const bool good = ::bind(fd, generic, size) == 0 && ::getsockname(fd, generic, &size) == 0;
  ::close(fd);
  if (!good)
    throw std::runtime_error("no port is free on this computer for a ROS master");
  return ntohs(address.sin_port);
}

/// Makes this process and its children use a master at a free port. @returns the port.
std::string chooseMaster() {
  const std::string port = std::to_string(freePort());
  ::setenv("ROS_IP", "127.0.0.1", 1);
  ::unsetenv("ROS_HOSTNAME");
  ::setenv("ROS_MASTER_URI", ("http://127.0.0.1:" + port + "/").c_str(), 1);
  return port;
}

}  // namespace

OwnMaster::OwnMaster()
    : process_([port = chooseMaster()] {
        ::execlp("rosmaster", "rosmaster", "--core", "-p", port.c_str(), nullptr);
      }) {}

void OwnMaster::connect() {
  ros::init(ros::M_string(), "benchmark_driver", ros::init_options::NoRosout);
  for (double waited = 0.0; !ros::master::check(); waited += 0.1) {
    if (process_.hasEnded() || waited > kMasterLimit)
      throw std::runtime_error(
          "no ROS master could be started: source ROS's setup.bash, so that rosmaster is found");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  // 32 nodelets log much about missing files.
  if (ros::console::set_logger_level("ros", ros::console::levels::Error))
    ros::console::notifyLoggerLevelsChanged();
}

}  // namespace wiimote_tracker
