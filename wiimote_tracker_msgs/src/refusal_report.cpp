#include "wiimote_tracker_msgs/refusal_report.h"

#include <diagnostic_msgs/DiagnosticArray.h>

#include <cstdlib>

namespace wiimote_tracker {
namespace {

/// Why a parameter was refused, and what to do where the process stays.
std::string refusalOf(const ParameterError& error) {
  return std::string(error.what()) +
         ". Change its file, and start the launch file again; or change it by rosparam, and: "
         "rosnode kill " +
         ros::this_node::getName();
}

}  // namespace

bool staysRefused(const ParameterError& error) {
  const bool stays = std::getenv("WIIMOTE_TRACKER_RESPAWNS") != nullptr;
  ROS_FATAL("%s", stays ? refusalOf(error).c_str() : error.what());
  return stays;
}

RefusalReport::RefusalReport(ros::NodeHandle nh,
                             const std::string& node,
                             const ParameterError& error)
    : publisher_(nh.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)) {
  status_.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  status_.name = node.substr(1) + ": parameters";
  status_.message = refusalOf(error);
  timer_ =
      nh.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publish(); });
}

void RefusalReport::publish() const {
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(status_);
  publisher_.publish(array);
}

}  // namespace wiimote_tracker
