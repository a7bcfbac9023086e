#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_SOLVE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_SOLVE_SERVICES_H

#include "node_context.h"

#include <wiimote_tracker_msgs/SolveCalibration.h>

namespace wiimote_tracker {

/// From what was captured to a rig and its verdict: solve; topic principal_point_trace.
class SolveServices {
 public:
  explicit SolveServices(NodeContext* context);

 private:
  workflow::Reply solve(const wiimote_tracker_msgs::SolveCalibration::Request& request,
                        wiimote_tracker_msgs::SolveCalibration::Response* response);

  NodeContext& context_;
  ros::Publisher trace_;
  ros::ServiceServer service_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_SOLVE_SERVICES_H
