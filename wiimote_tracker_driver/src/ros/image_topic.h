#ifndef WIIMOTE_TRACKER_DRIVER_ROS_IMAGE_TOPIC_H
#define WIIMOTE_TRACKER_DRIVER_ROS_IMAGE_TOPIC_H

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

namespace wiimote_tracker::driver {

/// A topic with a message for each image, made only for subscribers. Their number comes from ROS's
/// notices: ros::Publisher::getNumSubscribers() searches all topics, which is too long per image.
template <typename Message>
class ImageTopic {
 public:
  ImageTopic(ros::NodeHandle& nh, const std::string& name)
      : subscribers_(std::make_shared<std::atomic<int>>(0)) {
    // A notice may come after this object's end.
    const auto count = [subscribers = subscribers_](int change) {
      return
          [subscribers, change](const ros::SingleSubscriberPublisher&) { *subscribers += change; };
    };
    constexpr std::uint32_t kQueue = 20;
    publisher_ = nh.advertise<Message>(name, kQueue, count(1), count(-1));
  }

  bool subscribed() const { return *subscribers_ > 0; }
  /// Nodelets share the message, so each image needs its own.
  void publish(const boost::shared_ptr<Message>& message) const { publisher_.publish(message); }

 private:
  std::shared_ptr<std::atomic<int>> subscribers_;
  ros::Publisher publisher_;
};

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_IMAGE_TOPIC_H
