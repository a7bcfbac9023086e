#include "button_trigger.h"

namespace wiimote_tracker {

namespace {

constexpr std::size_t kButtonA = 2;  // as the driver orders them

}  // namespace

ButtonTrigger::ButtonTrigger(ros::NodeHandle* nh,
                             const std::string& remote,
                             const std::function<void()>& on_press)
    : on_press_(on_press) {
  if (!remote.empty())
    subscriber_ = nh->subscribe<sensor_msgs::Joy>(
        remote + "/joy", 10, [this](const sensor_msgs::JoyConstPtr& message) { onJoy(*message); });
}

void ButtonTrigger::onJoy(const sensor_msgs::Joy& message) {
  const bool pressed = message.buttons.size() > kButtonA && message.buttons[kButtonA] != 0;
  const bool now = pressed && !pressed_;
  pressed_ = pressed;
  if (now)
    on_press_();
}

}  // namespace wiimote_tracker
