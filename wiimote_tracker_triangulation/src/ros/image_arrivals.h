#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_IMAGE_ARRIVALS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_IMAGE_ARRIVALS_H

#include "inbox.h"

#include <ros/callback_queue_interface.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// An image and where it is from.
struct ArrivedImage {
  std::string camera;
  wiimote_tracker_msgs::IrBlobArrayConstPtr message;
  std::string node;  // that published it
};

/// Subscribes to cameras, and handles their images one at a time in the order of arrival: those
/// that are published in this process there and then in the thread that publishes them, since
/// waking another one takes longer than the tracking; all others, and everything else, in the
/// owner's thread, which is that of the handle's callback queue.
///
/// A thread that publishes holds locks of roscpp (of all publishing in this process, and of this
/// topic's subscriptions). Nothing locks up because
/// - it never waits for the owner's thread: while that one is busy, the image is left to it;
/// - all it does is to handle images, and this may publish but must not advertise, subscribe, count
///   publishers, or ask the master: these take their locks in the other order;
/// - roscpp's own thread, which delivers what comes over the network, holds locks in another order
///   as well, and latched messages are delivered while one subscribes: both are left to the owner.
class ImageArrivals {
 public:
  /// @param handle may publish at most. @param task of the owner's thread, when it was asked for.
  ImageArrivals(const ros::NodeHandle& nh,
                std::function<void(const ArrivedImage&)> handle,
                std::function<void()> task);
  /// When the owner's thread runs no more, or in it.
  ~ImageArrivals();
  ImageArrivals(const ImageArrivals&) = delete;
  ImageArrivals& operator=(const ImageArrivals&) = delete;

  /// From now on to these. Those that stay keep their connection, so that no image is lost. In the
  /// owner's thread.
  void subscribe(const std::vector<std::string>& cameras);

  /// No image is handled meanwhile. In the owner's thread.
  template <typename Task>
  void alone(Task task) {
    inbox_.alone(task);
  }

  /// Has the owner's thread do its task soon. From any thread.
  void askForTask();

 private:
  using Event = ros::MessageEvent<const wiimote_tracker_msgs::IrBlobArray>;

  /// Calls in the thread that delivers.
  class CallAtOnce : public ros::CallbackQueueInterface {
    void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
      callback->call();
    }
    void removeByID(std::uint64_t) override {}
  };

  void onImage(const std::string& camera, const Event& event);
  std::uint64_t id() const;

  ros::NodeHandle nh_;
  Inbox<ArrivedImage> inbox_;
  ros::CallbackInterfacePtr task_;
  CallAtOnce at_once_;
  std::map<std::string, ros::Subscriber> subscribers_;  // by camera
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_IMAGE_ARRIVALS_H
