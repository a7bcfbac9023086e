#include "joy_feedback.h"

#include <ros/console.h>

namespace wiimote_tracker::driver {
namespace {

constexpr int kLeds = 4;
constexpr float kOn = 0.5f;
constexpr double kRepeatWarning = 30.0;  // [s]

}  // namespace

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
