#ifndef WIIMOTE_TRACKER_DRIVER_ROS_PLAYER_LEDS_H
#define WIIMOTE_TRACKER_DRIVER_ROS_PLAYER_LEDS_H

#include <cstdint>
#include <string>

namespace wiimote_tracker::driver {

/// Player LEDs 1..4 (bits 0..3) that show the number at the end of a camera's name: the numbers of
/// the LEDs add up to it. 1..4 are single LEDs, 5 is 1 + 4, 10 is all four; from 11 on it begins
/// again, and 0 is as 10. A name without a number lights LED 1.
std::uint8_t playerLeds(const std::string& camera_name);

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_PLAYER_LEDS_H
