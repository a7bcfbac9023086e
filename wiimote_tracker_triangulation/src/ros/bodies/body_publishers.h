#pragma once

#include "../tracker/publish_each.h"
#include "body/constellation.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <boost/make_shared.hpp>

#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Publishes all bodies on `bodies`, and each one by itself (see publishEach()).
class BodyPublishers {
 public:
  BodyPublishers(const ros::NodeHandle& nh, const OutputOptions& options)
      : nh_(nh),
        options_(options),
        all_(nh_.advertise<wiimote_tracker_msgs::TrackedBodyArray>("bodies", 100)) {}

  /// Advertises the topics of these bodies. Those of bodies that stay keep their subscribers.
  void setBodies(const std::vector<body::Constellation>& bodies) {
    const auto kept_until_the_end = std::exchange(topics_, {});
    for (const body::Constellation& body : bodies) {
      advertise<geometry_msgs::PoseWithCovarianceStamped>(body.name + "/pose");
      advertise<geometry_msgs::TwistWithCovarianceStamped>(body.name + "/twist");
      advertise<nav_msgs::Odometry>(body.name + "/odometry");
    }
  }

  /// @param bridged for each body of the message, whether its topics go on while it is predicted.
  void publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
               const std::vector<bool>& bridged) {
    all_.publish(bodies);
    const auto transforms = publishEach(
        bodies, bridged, options_, [this](const std::string& topic, const auto& message) {
          const auto found = topics_.find(topic);
          if (found != topics_.end())
            found->second.publish(boost::make_shared<std::decay_t<decltype(message)>>(message));
        });
    if (!transforms.empty())
      broadcaster_.sendTransform(transforms);
  }

 private:
  template <typename Message>
  void advertise(const std::string& topic) {
    topics_[topic] = nh_.advertise<Message>(topic, 100);
  }

  ros::NodeHandle nh_;
  OutputOptions options_;
  ros::Publisher all_;
  std::map<std::string, ros::Publisher> topics_;  // by name
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace wiimote_tracker
