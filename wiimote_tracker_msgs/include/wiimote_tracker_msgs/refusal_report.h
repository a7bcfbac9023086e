#pragma once

#include "wiimote_tracker_msgs/parameter_reader.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <cstdlib>
#include <string>

namespace wiimote_tracker {

/// Why a parameter was refused, and what to do where the process stays.
inline std::string refusalOf(const ParameterError& error) {
  return std::string(error.what()) +
         ". Change its file, and start the launch file again; or change it by rosparam, and: "
         "rosnode kill " +
         ros::this_node::getName();
}

/// Says why a parameter was refused. Started again, this process would refuse it again, once a
/// second: one that roslaunch starts again, as launch files tell it by WIIMOTE_TRACKER_RESPAWNS,
/// therefore has to stay. @returns whether it has to.
inline bool staysRefused(const ParameterError& error) {
  const bool stays = std::getenv("WIIMOTE_TRACKER_RESPAWNS") != nullptr;
  ROS_FATAL("%s", stays ? refusalOf(error).c_str() : error.what());
  return stays;
}

/// Repeats in the diagnostics, once a second, why a node that stays does nothing.
class RefusalReport {
 public:
  /// @param node its full name. Its callbacks have to be handled.
  RefusalReport(ros::NodeHandle nh, const std::string& node, const ParameterError& error)
      : publisher_(nh.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)) {
    status_.level = diagnostic_msgs::DiagnosticStatus::ERROR;
    status_.name = node.substr(1) + ": parameters";
    status_.message = refusalOf(error);
    timer_ = nh.createWallTimer(ros::WallDuration(1.0),
                                [this](const ros::WallTimerEvent&) { publish(); });
  }
  RefusalReport(const RefusalReport&) = delete;
  RefusalReport& operator=(const RefusalReport&) = delete;

 private:
  void publish() const {
    diagnostic_msgs::DiagnosticArray array;
    array.header.stamp = ros::Time::now();
    array.status.push_back(status_);
    publisher_.publish(array);
  }

  ros::Publisher publisher_;
  diagnostic_msgs::DiagnosticStatus status_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker
