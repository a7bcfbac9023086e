#pragma once

#include "tracker/publish_each.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

namespace wiimote_tracker {

/// Publishes each LED by itself (see publishEach()). The topics of listed labels exist from the
/// start, those of other LEDs from their first point until they are lost or get a listed label.
/// Those are advertised in another thread, one after the other: while there is no ROS master,
/// advertising waits for it.
class LedPublishers {
 public:
  LedPublishers(const ros::NodeHandle& nh,
                const std::vector<std::string>& labels,
                const OutputOptions& options)
      : nh_(nh), listed_(labels.begin(), labels.end()), options_(options) {
    for (const std::string& label : listed_) {
      const std::string point = label + "/point", odometry = label + "/odometry";
      topics_[point] = advertise<geometry_msgs::PointStamped>(nh_, point);
      if (options_.led_odometry)
        topics_[odometry] = advertise<nav_msgs::Odometry>(nh_, odometry);
    }
  }

  void publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
    if (advertising_.valid() &&
        advertising_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      topics_[advertised_] = advertising_.get();
    const auto transforms =
        publishEach(points, options_, [this](const std::string& topic, const auto& message) {
          using Message = std::decay_t<decltype(message)>;
          if (const ros::Publisher* publisher = publisherOf<Message>(topic))
            publisher->publish(boost::make_shared<Message>(message));
        });
    if (!transforms.empty())
      broadcaster_.sendTransform(transforms);
    removeUnused(points);
  }

 private:
  template <typename Message>
  static ros::Publisher advertise(ros::NodeHandle nh, const std::string& topic) {
    return nh.advertise<Message>(topic, 100);
  }

  /// Null until it is advertised.
  template <typename Message>
  const ros::Publisher* publisherOf(const std::string& topic) {
    const auto found = topics_.find(topic);
    if (found != topics_.end())
      return &found->second;
    if (!advertising_.valid()) {
      advertised_ = topic;
      advertising_ = std::async(std::launch::async, advertise<Message>, nh_, topic);
    }
    return nullptr;
  }

  void removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
    using wiimote_tracker_msgs::TrackedPoint;
    for (auto topic = topics_.begin(); topic != topics_.end();) {
      const std::string label = topic->first.substr(0, topic->first.rfind('/'));
      const bool is_used =
          listed_.count(label) > 0 ||
          std::any_of(points.points.begin(), points.points.end(), [&](const TrackedPoint& point) {
            return point.label == label && point.state != TrackedPoint::LOST;
          });
      topic = is_used ? std::next(topic) : topics_.erase(topic);
    }
  }

  ros::NodeHandle nh_;
  std::set<std::string> listed_;
  OutputOptions options_;
  std::map<std::string, ros::Publisher> topics_;  // by name
  std::string advertised_;                        // topic
  std::future<ros::Publisher> advertising_;       // invalid: none is being advertised
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace wiimote_tracker
