#pragma once

#include "body/constellation.h"
#include "tracker/publish_each.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes each LED and each body by itself (see publishEach()). The topics of listed labels
/// exist from the start, those of bodies from setBodies(), those of other LEDs from their first
/// point until they are lost or get a listed label. The latter are advertised in another thread,
/// one topic after the other: while there is no ROS master, advertising waits for it.
class SinglePublishers {
 public:
  SinglePublishers(const ros::NodeHandle& nh,
                   const std::vector<std::string>& labels,
                   const OutputOptions& options)
      : nh_(nh), options_(options), labels_(labels.begin(), labels.end()) {
    for (const std::string& label : labels) {
      advertise<geometry_msgs::PointStamped>(label + "/point");
      if (options_.led_odometry)
        advertise<nav_msgs::Odometry>(label + "/odometry");
    }
  }

  /// The bodies from now on. The topics of others end with the next points. Bodies that stay keep
  /// their subscribers: the new publisher begins before the old one ends.
  void setBodies(const std::vector<body::Constellation>& bodies) {
    bodies_.clear();
    for (const body::Constellation& body : bodies) {
      bodies_.insert(body.name);
      advertise<geometry_msgs::PoseWithCovarianceStamped>(body.name + "/pose");
      advertise<geometry_msgs::TwistWithCovarianceStamped>(body.name + "/twist");
      advertise<nav_msgs::Odometry>(body.name + "/odometry");
    }
  }

  void publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
    if (advertising_.valid() &&
        advertising_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      topics_[advertised_] = advertising_.get();
    send(publishEach(points, options_, [this](const auto& topic, const auto& message) {
      publishOn(topic, message);
    }));
    removeUnused(points);
  }

  /// @param bridged see MessageSink.
  void publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
               const std::vector<bool>& bridged) {
    send(publishEach(bodies, bridged, options_, [this](const auto& topic, const auto& message) {
      publishOn(topic, message);
    }));
  }

 private:
  template <typename Message>
  void advertise(const std::string& topic) {
    topics_[topic] = nh_.advertise<Message>(topic, 100);
  }

  /// Begins to advertise the topic if it is not.
  template <typename Message>
  void publishOn(const std::string& topic, const Message& message) {
    const auto found = topics_.find(topic);
    if (found != topics_.end()) {
      found->second.publish(boost::make_shared<Message>(message));
    } else if (!advertising_.valid()) {
      advertised_ = topic;
      advertising_ = std::async(std::launch::async, [nh = nh_, topic]() mutable {
        return nh.advertise<Message>(topic, 100);
      });
    }
  }

  void send(const std::vector<geometry_msgs::TransformStamped>& transforms) {
    if (!transforms.empty())
      broadcaster_.sendTransform(transforms);
  }

  void removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
    using wiimote_tracker_msgs::TrackedPoint;
    for (auto topic = topics_.begin(); topic != topics_.end();) {
      const std::string name = topic->first.substr(0, topic->first.rfind('/'));
      const bool is_used =
          labels_.count(name) > 0 || bodies_.count(name) > 0 ||
          std::any_of(points.points.begin(), points.points.end(), [&](const TrackedPoint& point) {
            return point.label == name && point.state != TrackedPoint::LOST;
          });
      topic = is_used ? std::next(topic) : topics_.erase(topic);
    }
  }

  ros::NodeHandle nh_;
  OutputOptions options_;
  std::set<std::string> labels_, bodies_;         // whose topics stay
  std::map<std::string, ros::Publisher> topics_;  // by name
  std::string advertised_;                        // topic
  std::future<ros::Publisher> advertising_;       // invalid: none is being advertised
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace wiimote_tracker
