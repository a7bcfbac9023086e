#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_RECALIBRATE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_RECALIBRATE_SERVICES_H

#include "capture/rest_gravity.h"
#include "recalibrate/recalibrate_camera.h"

#include "node_context.h"

#include <wiimote_tracker_msgs/RecalibrateCamera.h>

#include <optional>
#include <string>

namespace wiimote_tracker {

/// Solves one camera against the others: recalibrate_camera.
class RecalibrateServices {
 public:
  explicit RecalibrateServices(NodeContext* context);

 private:
  workflow::Reply recalibrate(const wiimote_tracker_msgs::RecalibrateCamera::Request& request,
                              wiimote_tracker_msgs::RecalibrateCamera::Response* response);

  NodeContext& context_;
  // While an LED is waved:
  std::optional<recalibrate::Request> recording_;
  capture::RestGravity gravity_;
  ros::ServiceServer service_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_RECALIBRATE_SERVICES_H
