#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H

#include "button_trigger.h"
#include "node_context.h"

#include <actionlib/server/simple_action_server.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/StartCalibration.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The square: check_connection, start, capture_corner, hands_free, undo, cancel; and the button of
/// a hand-held remote.
class CaptureServices {
 public:
  explicit CaptureServices(NodeContext* context);

 private:
  using Capture = actionlib::SimpleActionServer<wiimote_tracker_msgs::CaptureCornerAction>;

  bool checkConnection(wiimote_tracker_msgs::CheckConnection::Request& request,
                       wiimote_tracker_msgs::CheckConnection::Response& response);
  bool start(wiimote_tracker_msgs::StartCalibration::Request& request,
             wiimote_tracker_msgs::StartCalibration::Response& response);
  bool handsFree(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool undo(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool cancel(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void captureCorner(const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal);

  workflow::Reply start(const wiimote_tracker_msgs::StartCalibration::Request& request,
                        const Lock& lock);
  /// The cameras to calibrate; a sentence when there is one among them that is not there.
  workflow::Reply chooseCameras(std::vector<std::string>* cameras, const Lock& lock);
  void onButton();
  /// Until the capture is over, called off or cancelled.
  workflow::Reply waitForCapture(Lock* lock);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
  Capture capture_server_;
  ButtonTrigger button_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H
