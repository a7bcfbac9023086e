#ifndef WIIMOTE_TRACKER_DRIVER_ROS_JOY_PUBLISHER_H
#define WIIMOTE_TRACKER_DRIVER_ROS_JOY_PUBLISHER_H

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_JOY_PUBLISHER_H
