#pragma once

#include <cstdlib>
#include <string>

namespace wiimote_tracker {

/// The folder of this user's files of ROS: ROS_HOME, else ~/.ros.
inline std::string rosHome() {
  const char* const ros_home = std::getenv("ROS_HOME");
  if (ros_home != nullptr && *ros_home != '\0')
    return ros_home;
  const char* const home = std::getenv("HOME");
  return std::string(home != nullptr ? home : "") + "/.ros";
}

}  // namespace wiimote_tracker
