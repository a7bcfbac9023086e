#include "joy_publisher.h"

#include <sensor_msgs/Joy.h>

namespace wiimote_tracker::driver {
namespace {

// Bits of protocol::decodeButtons(), in the order of joyButtons().
constexpr std::uint16_t kBits[] = {0x0002, 0x0001, 0x0008, 0x0004, 0x1000, 0x0010,
                                   0x0100, 0x0200, 0x0800, 0x0400, 0x0080};

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

}  // namespace wiimote_tracker::driver
