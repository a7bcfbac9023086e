#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CALIBRATION_NODE_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CALIBRATION_NODE_H

#include "wiimote_tracker_calibration/workflow/calibration.h"

#include "camera_inputs.h"
#include "parameters.h"
#include "rig_output.h"

#include <actionlib/server/simple_action_server.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/SaveRig.h>
#include <wiimote_tracker_msgs/SolveCalibration.h>
#include <wiimote_tracker_msgs/StartCalibration.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Leads through the four-corner calibration by services and an action. Spin it with several
/// threads: services wait for images.
class CalibrationNode {
 public:
  /// Loads and publishes the last saved rig, if there is one.
  CalibrationNode(const ros::NodeHandle& nh, const Parameters& parameters);

 private:
  using Capture = actionlib::SimpleActionServer<wiimote_tracker_msgs::CaptureCornerAction>;

  bool checkConnection(wiimote_tracker_msgs::CheckConnection::Request& request,
                       wiimote_tracker_msgs::CheckConnection::Response& response);
  bool start(wiimote_tracker_msgs::StartCalibration::Request& request,
             wiimote_tracker_msgs::StartCalibration::Response& response);
  bool undo(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool cancel(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool solve(wiimote_tracker_msgs::SolveCalibration::Request& request,
             wiimote_tracker_msgs::SolveCalibration::Response& response);
  bool save(wiimote_tracker_msgs::SaveRig::Request& request,
            wiimote_tracker_msgs::SaveRig::Response& response);
  bool load(wiimote_tracker_msgs::LoadRig::Request& request,
            wiimote_tracker_msgs::LoadRig::Response& response);
  void captureCorner(const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal);

  workflow::Reply startWith(double side_x, double side_y, std::vector<std::string> cameras);
  /// Until the capture is over, called off or cancelled.
  workflow::Reply waitForCapture(std::unique_lock<std::mutex>* lock);
  /// Shows a refusal in the status too.
  workflow::Reply noted(const workflow::Reply& reply);
  workflow::Reply loadFile(const std::string& path);
  /// Starting values of the cameras of this run; a sentence when some do not fit their images.
  workflow::Reply collectFacts(std::map<std::string, workflow::CameraFacts>* facts) const;
  void publishStatus();

  // Guards calibration_ and what inputs_ hands out; changed_ tells of each image.
  std::mutex mutex_;
  std::condition_variable changed_;
  ros::NodeHandle nh_;
  Parameters parameters_;
  workflow::Calibration calibration_;
  ros::Publisher status_publisher_;
  RigOutput rig_output_;
  CameraInputs inputs_;
  ros::WallTimer status_timer_;
  std::vector<ros::ServiceServer> services_;
  Capture capture_server_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CALIBRATION_NODE_H
