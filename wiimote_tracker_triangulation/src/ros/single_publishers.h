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
      : nh_(nh), options_(options) {
    for (const std::string& label : labels) {
      advertise<geometry_msgs::PointStamped>(label + "/point", &label_topics_);
      if (options_.led_odometry)
        advertise<nav_msgs::Odometry>(label + "/odometry", &label_topics_);
    }
  }

  /// The bodies from now on. The topics of others end. Bodies that stay keep their subscribers: the
  /// new publisher begins before the old one ends.
  void setBodies(const std::vector<body::Constellation>& bodies) {
    Topics topics;
    for (const body::Constellation& body : bodies) {
      advertise<geometry_msgs::PoseWithCovarianceStamped>(body.name + "/pose", &topics);
      advertise<geometry_msgs::TwistWithCovarianceStamped>(body.name + "/twist", &topics);
      advertise<nav_msgs::Odometry>(body.name + "/odometry", &topics);
    }
    body_topics_.swap(topics);
  }

  void publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
    if (advertising_.valid() &&
        advertising_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      passing_topics_[advertised_] = advertising_.get();
    send(publishEach(points, options_, [this](const auto& topic, const auto& message) {
      if (!publishOn(label_topics_, topic, message) && !publishOn(passing_topics_, topic, message))
        beginToAdvertise(topic, message);
    }));
    removeUnused(points);
  }

  /// @param bridged see MessageSink.
  void publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
               const std::vector<bool>& bridged) {
    send(publishEach(bodies, bridged, options_, [this](const auto& topic, const auto& message) {
      publishOn(body_topics_, topic, message);
    }));
  }

 private:
  using Topics = std::map<std::string, ros::Publisher>;  // by name

  template <typename Message>
  void advertise(const std::string& topic, Topics* topics) {
    (*topics)[topic] = nh_.advertise<Message>(topic, 100);
  }

  /// @returns whether the topic is among them.
  template <typename Message>
  static bool publishOn(const Topics& topics, const std::string& topic, const Message& message) {
    const auto found = topics.find(topic);
    if (found == topics.end())
      return false;
    found->second.publish(boost::make_shared<Message>(message));
    return true;
  }

  /// Unless another topic is just being advertised.
  template <typename Message>
  void beginToAdvertise(const std::string& topic, const Message& /*of its type*/) {
    if (advertising_.valid())
      return;
    advertised_ = topic;
    advertising_ = std::async(std::launch::async, [nh = nh_, topic]() mutable {
      return nh.advertise<Message>(topic, 100);
    });
  }

  void send(const std::vector<geometry_msgs::TransformStamped>& transforms) {
    if (!transforms.empty())
      broadcaster_.sendTransform(transforms);
  }

  void removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
    using wiimote_tracker_msgs::TrackedPoint;
    for (auto topic = passing_topics_.begin(); topic != passing_topics_.end();) {
      const std::string label = topic->first.substr(0, topic->first.rfind('/'));
      const bool is_used =
          std::any_of(points.points.begin(), points.points.end(), [&](const TrackedPoint& point) {
            return point.label == label && point.state != TrackedPoint::LOST;
          });
      topic = is_used ? std::next(topic) : passing_topics_.erase(topic);
    }
  }

  ros::NodeHandle nh_;
  OutputOptions options_;
  Topics label_topics_, body_topics_;
  Topics passing_topics_;                    // of LEDs without a listed label
  std::string advertised_;                   // topic
  std::future<ros::Publisher> advertising_;  // invalid: none is being advertised
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace wiimote_tracker
