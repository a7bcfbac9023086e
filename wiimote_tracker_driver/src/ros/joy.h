#pragma once

#include "remote_control.h"

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JoyFeedbackArray.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The remote as a joystick: its buttons, LEDs and motor.
namespace wiimote_tracker::driver {

/// Joy::buttons, 1 for each pressed one: 1, 2, A, B, plus, minus, left, right, up, down, home, as
/// in the node `wiimote` of joystick_drivers. `buttons`: as protocol::decodeButtons().
std::vector<int> joyButtons(std::uint16_t buttons);

/// Publishes the buttons, latched, as `joy` whenever one changes.
class JoyPublisher {
 public:
  JoyPublisher(ros::NodeHandle& nh, const std::string& frame_id);

  /// `buttons`: as protocol::decodeButtons().
  void publish(std::uint16_t buttons, const ros::Time& stamp);

  /// Publishes all buttons as released, when the remote has disconnected.
  void release(const ros::Time& stamp);

 private:
  const std::string frame_id_;
  ros::Publisher publisher_;
  std::optional<std::uint16_t> published_;
};

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
