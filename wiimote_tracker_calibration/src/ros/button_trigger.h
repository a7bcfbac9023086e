#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_BUTTON_TRIGGER_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_BUTTON_TRIGGER_H

#include <ros/node_handle.h>
#include <sensor_msgs/Joy.h>

#include <functional>
#include <string>

namespace wiimote_tracker {

/// Button A of a hand-held Wii Remote.
class ButtonTrigger {
 public:
  /// @param remote its namespace; empty: there is none. @param on_press called once per press.
  ButtonTrigger(ros::NodeHandle* nh,
                const std::string& remote,
                const std::function<void()>& on_press);

 private:
  void onJoy(const sensor_msgs::Joy& message);

  std::function<void()> on_press_;
  // The first message is latched: a button that it shows was pressed earlier.
  bool pressed_ = true;
  ros::Subscriber subscriber_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_BUTTON_TRIGGER_H
