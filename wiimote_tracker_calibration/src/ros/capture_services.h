#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H

#include "node_context.h"

#include <actionlib/server/simple_action_server.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/StartCalibration.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The square: check_connection, start, capture_corner, undo, cancel.
class CaptureServices {
 public:
  explicit CaptureServices(NodeContext* context);

 private:
  using Capture = actionlib::SimpleActionServer<wiimote_tracker_msgs::CaptureCornerAction>;

  bool checkConnection(wiimote_tracker_msgs::CheckConnection::Request& request,
                       wiimote_tracker_msgs::CheckConnection::Response& response);
  bool start(wiimote_tracker_msgs::StartCalibration::Request& request,
             wiimote_tracker_msgs::StartCalibration::Response& response);
  bool undo(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool cancel(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void captureCorner(const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal);

  workflow::Reply startWith(double side_x,
                            double side_y,
                            std::vector<std::string> cameras,
                            const Lock& lock);
  /// Until the capture is over, called off or cancelled.
  workflow::Reply waitForCapture(Lock* lock);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
  Capture capture_server_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H
