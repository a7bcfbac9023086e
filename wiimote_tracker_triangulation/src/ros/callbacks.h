#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CALLBACKS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CALLBACKS_H

#include <ros/console.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <exception>
#include <string>

/// No exception may leave a callback: roscpp would end the process, with all nodelets in it.
namespace wiimote_tracker {

/// Calls `work` and logs what it throws.
template <typename Work>
void logExceptions(const std::string& callback, const Work& work) {
  try {
    work();
  } catch (const std::exception& e) {
    ROS_ERROR_THROTTLE(1.0, "%s: %s", callback.c_str(), e.what());
  }
}

/// Subscribes without Nagle's algorithm, which delays small messages.
/// @param queue_size messages that may wait; then roscpp drops the oldest.
/// @param callback void(const ros::MessageEvent<const Message>&); what it throws is logged.
template <typename Message, typename Callback>
ros::Subscriber subscribe(ros::NodeHandle nh,
                          const std::string& topic,
                          std::uint32_t queue_size,
                          const Callback& callback) {
  using Event = ros::MessageEvent<const Message>;
  return nh.subscribe<Message, const Event&>(
      topic, queue_size,
      [topic, callback](const Event& event) {
        logExceptions("message on " + topic, [&] { callback(event); });
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_CALLBACKS_H
