#pragma once

#include "callbacks.h"

#include <ros/console.h>
#include <wiimote_tracker_msgs/RigCalibration.h>

#include <functional>
#include <string>
#include <utility>

namespace wiimote_tracker {

/// The rig in use, from calibration/rig.
///
/// A bag that is played beside the calibration node publishes a rig, too, which would stay in use
/// after the bag. So the rig of a second publisher is ignored while the first one is connected, and
/// when one is left, its rig is taken.
class RigSubscription {
 public:
  using Message = wiimote_tracker_msgs::RigCalibration;

  /// @param take gets each rig; what it throws is logged.
  void start(const ros::NodeHandle& nh, std::function<void(const Message&)> take) {
    nh_ = nh;
    take_ = std::move(take);
    subscribe();
    timer_ = nh_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
      logExceptions("timer", [this] { takeTheOneLeft(); });
    });
  }

  std::string topic() const { return subscriber_.getTopic(); }

 private:
  void subscribe() {
    subscriber_ = wiimote_tracker::subscribe<Message>(nh_, "calibration/rig", 5,
                                                      [this](const auto& event) { onRig(event); });
  }

  void onRig(const ros::MessageEvent<const Message>& event) {
    const std::string publisher = event.getPublisherName();
    if (!publisher_.empty() && publisher != publisher_ && subscriber_.getNumPublishers() > 1) {
      ROS_WARN("The rig of %s on %s is ignored, since %s publishes one, too: end one of them.",
               publisher.c_str(), topic().c_str(), publisher_.c_str());
      has_ignored_ = true;
      return;
    }
    publisher_ = publisher;
    take_(*event.getConstMessage());
  }

  void takeTheOneLeft() {
    if (!has_ignored_ || subscriber_.getNumPublishers() != 1)
      return;
    has_ignored_ = false;
    publisher_.clear();
    subscribe();  // brings its latched rig
  }

  ros::NodeHandle nh_;
  std::function<void(const Message&)> take_;
  std::string publisher_;     // of the rig in use
  bool has_ignored_ = false;  // a rig of another publisher
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker
