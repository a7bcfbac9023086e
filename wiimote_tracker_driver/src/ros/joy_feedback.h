#ifndef WIIMOTE_TRACKER_DRIVER_ROS_JOY_FEEDBACK_H
#define WIIMOTE_TRACKER_DRIVER_ROS_JOY_FEEDBACK_H

#include "remote_control.h"

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JoyFeedbackArray.h>

#include <string>

namespace wiimote_tracker::driver {

/// Subscribes to `joy/set_feedback`: TYPE_LED, id 0..3 (player LEDs 1..4), and TYPE_RUMBLE, id 0.
/// An intensity of at least 0.5 means on. Outputs that a message does not name stay as they are.
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
