#include "joy_publisher.h"

#include <sensor_msgs/Joy.h>

#include <cstddef>

namespace wiimote_tracker::driver {
namespace {

// Bits of protocol::decodeButtons(), in the order of JoyButton.
constexpr std::array<std::uint16_t, kButtonCount> kBits{
    0x0002, 0x0001, 0x0008, 0x0004, 0x1000, 0x0010, 0x0100, 0x0200, 0x0800, 0x0400, 0x0080};

}  // namespace

std::array<int, kButtonCount> joyButtons(std::uint16_t buttons) {
  std::array<int, kButtonCount> pressed{};
  for (std::size_t i = 0; i < pressed.size(); ++i)
    pressed[i] = (buttons & kBits[i]) != 0 ? 1 : 0;
  return pressed;
}

JoyPublisher::JoyPublisher(ros::NodeHandle& nh, const std::string& frame_id)
    : frame_id_(frame_id), publisher_(nh.advertise<sensor_msgs::Joy>("joy", 10, true)) {}

void JoyPublisher::publish(std::uint16_t buttons, const ros::Time& stamp) {
  if (!changed(buttons))
    return;
  published_ = buttons;
  const std::array<int, kButtonCount> pressed = joyButtons(buttons);
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.header.frame_id = frame_id_;
  message.buttons.assign(pressed.begin(), pressed.end());
  publisher_.publish(message);
}

void JoyPublisher::release(const ros::Time& stamp) {
  if (published_)
    publish(0, stamp);
}

}  // namespace wiimote_tracker::driver
