#ifndef WIIMOTE_TRACKER_DRIVER_ROS_JOY_FEEDBACK_H
#define WIIMOTE_TRACKER_DRIVER_ROS_JOY_FEEDBACK_H

#include "remote_control.h"

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JoyFeedbackArray.h>

#include <string>

namespace wiimote_tracker::driver {

/// Listens on `joy/set_feedback`: TYPE_LED, id 0..3 (player LEDs 1..4), and TYPE_RUMBLE, id 0; on
/// from an intensity of 0.5. What a message does not name stays as it is.
class JoyFeedback {
 public:
  /// `control` must outlive this.
  JoyFeedback(ros::NodeHandle& nh, const std::string& camera, RemoteControl& control);

 private:
  void handle(const sensor_msgs::JoyFeedbackArray& message);

  const std::string camera_;
  RemoteControl& control_;
  ros::Subscriber subscriber_;
};

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_JOY_FEEDBACK_H
