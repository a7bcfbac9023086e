#include "joy.h"

#include <ros/console.h>
#include <sensor_msgs/Joy.h>

namespace wiimote_tracker::driver {
namespace {

// Bits of protocol::decodeButtons(), in the order of joyButtons().
constexpr std::uint16_t kBits[] = {0x0002, 0x0001, 0x0008, 0x0004, 0x1000, 0x0010,
                                   0x0100, 0x0200, 0x0800, 0x0400, 0x0080};
constexpr int kLeds = 4;
constexpr float kOn = 0.5f;
constexpr double kRepeatWarning = 30.0;  // [s]

}  // namespace

std::vector<int> joyButtons(std::uint16_t buttons) {
  std::vector<int> pressed;
  for (const std::uint16_t bit : kBits)
    pressed.push_back((buttons & bit) != 0 ? 1 : 0);
  return pressed;
}

JoyPublisher::JoyPublisher(ros::NodeHandle& nh, const std::string& frame_id)
    : frame_id_(frame_id), publisher_(nh.advertise<sensor_msgs::Joy>("joy", 10, true)) {}

void JoyPublisher::publish(std::uint16_t buttons, const ros::Time& stamp) {
  if (published_ == buttons)
    return;
  published_ = buttons;
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.header.frame_id = frame_id_;
  message.buttons = joyButtons(buttons);
  publisher_.publish(message);
}

void JoyPublisher::release(const ros::Time& stamp) {
  if (published_)
    publish(0, stamp);
}

JoyFeedback::JoyFeedback(ros::NodeHandle& nh, const std::string& camera, RemoteControl& control)
    : camera_(camera),
      control_(control),
      subscriber_(nh.subscribe("joy/set_feedback", 10, &JoyFeedback::handle, this)) {}

void JoyFeedback::handle(const sensor_msgs::JoyFeedbackArray& message) {
  for (const sensor_msgs::JoyFeedback& feedback : message.array) {
    const bool on = feedback.intensity >= kOn;  // false for NaN
    if (feedback.type == sensor_msgs::JoyFeedback::TYPE_LED && feedback.id < kLeds) {
      const auto bit = static_cast<std::uint8_t>(1 << feedback.id);
      control_.setLeds(on ? bit : 0, bit);
    } else if (feedback.type == sensor_msgs::JoyFeedback::TYPE_RUMBLE && feedback.id == 0) {
      control_.setRumble(on);
    } else {
      ROS_WARN_THROTTLE(kRepeatWarning,
                        "%s: joy/set_feedback asks for type %d, id %d, but a Wii Remote has only "
                        "LEDs (type 0, id 0 to 3) and rumble (type 1, id 0)",
                        camera_.c_str(), feedback.type, feedback.id);
    }
  }
}

}  // namespace wiimote_tracker::driver
