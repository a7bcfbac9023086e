#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <wiimote_tracker_msgs/log_exceptions.h>

#include <cstdint>
#include <exception>
#include <string>

namespace wiimote_tracker {

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

/// Answers a request with the sentence that `work` returns, or, as a refusal, with what it throws.
template <typename Response, typename Work>
bool answer(Response* response, const Work& work) {
  try {
    response->message = work();
    response->success = true;
  } catch (const std::exception& e) {
    response->message = e.what();
    response->success = false;
  }
  return true;
}

}  // namespace wiimote_tracker
