#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H

#include "node_context.h"

#include <actionlib/server/simple_action_server.h>
#include <sensor_msgs/Joy.h>
#include <std_srvs/SetBool.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/StartCalibration.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The square: check_connection, start, capture_corner, hands_free, undo, cancel; and button A of a
/// hand-held remote, which captures.
class CaptureServices {
 public:
  explicit CaptureServices(NodeContext* context);

 private:
  using Capture = actionlib::SimpleActionServer<wiimote_tracker_msgs::CaptureCornerAction>;

  workflow::Reply checkConnection(const wiimote_tracker_msgs::CheckConnection::Request& request,
                                  wiimote_tracker_msgs::CheckConnection::Response* response);
  workflow::Reply start(const wiimote_tracker_msgs::StartCalibration::Request& request,
                        wiimote_tracker_msgs::StartCalibration::Response* response);
  workflow::Reply handsFree(const std_srvs::SetBool::Request& request,
                            std_srvs::SetBool::Response* response);
  workflow::Reply undo();
  workflow::Reply cancel();
  void captureCorner(const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal);
  void onJoy(const sensor_msgs::Joy& message);

  /// The cameras to calibrate; all when none is named.
  /// @throws Refusal: one of them is not there, or is the hand-held remote.
  std::vector<std::string> chooseCameras(std::vector<std::string> names, const Lock& lock);
  /// Waits until the capture has ended, was preempted or cancelled.
  workflow::Reply waitForCapture(Lock* lock);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
  Capture capture_server_;
  // The first message is latched: a button that it shows was pressed earlier.
  bool button_was_pressed_ = true;
  ros::Subscriber button_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAPTURE_SERVICES_H
