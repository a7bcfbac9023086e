#pragma once

#include "wiimote_tracker_msgs/parameter_reader.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/ros.h>

#include <string>

namespace wiimote_tracker {

/// Says why a parameter was refused. Started again, this process would refuse it again, once a
/// second: one that roslaunch starts again, as launch files tell it by WIIMOTE_TRACKER_RESPAWNS,
/// therefore has to stay. @returns whether it has to.
bool staysRefused(const ParameterError& error);

/// Repeats in the diagnostics, once a second, why a node that stays does nothing.
class RefusalReport {
 public:
  /// @param node its full name. Its callbacks have to be handled.
  RefusalReport(ros::NodeHandle nh, const std::string& node, const ParameterError& error);
  RefusalReport(const RefusalReport&) = delete;
  RefusalReport& operator=(const RefusalReport&) = delete;

 private:
  void publish() const;

  ros::Publisher publisher_;
  diagnostic_msgs::DiagnosticStatus status_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker
