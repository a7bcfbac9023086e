#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

namespace wiimote_tracker::driver {

/// A topic with a message for each image, made only for subscribers. Whether there are any is asked
/// at the first image, and again after each of ROS's notices: ros::Publisher::getNumSubscribers()
/// searches all topics, which takes too long per image. No notice may get lost; a nodelet manager
/// may drop some, so nodelets use OwnThread.
template <typename Message>
class ImageTopic {
 public:
  ImageTopic(ros::NodeHandle& nh, const std::string& name)
      : has_changed_(std::make_shared<std::atomic<bool>>(true)) {
    // A notice may come after this object's end.
    const auto note = [changed = has_changed_](const ros::SingleSubscriberPublisher&) {
      *changed = true;
    };
    constexpr std::uint32_t kQueue = 20;
    publisher_ = nh.advertise<Message>(name, kQueue, note, note);
  }

  /// For the thread that publishes.
  bool subscribed() {
    if (has_changed_->exchange(false))
      is_subscribed_ = publisher_.getNumSubscribers() > 0;
    return is_subscribed_;
  }

  /// Nodelets share the message, so each image needs its own.
  void publish(const boost::shared_ptr<Message>& message) { publisher_.publish(message); }

 private:
  std::shared_ptr<std::atomic<bool>> has_changed_;
  bool is_subscribed_ = false;
  ros::Publisher publisher_;
};

}  // namespace wiimote_tracker::driver
