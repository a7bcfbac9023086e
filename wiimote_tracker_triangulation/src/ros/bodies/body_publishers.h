#pragma once

#include "../tracker/body_message.h"
#include "../tracker/parameters.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <boost/make_shared.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Publishes all bodies on `bodies`, and for each one its pose on <body>/pose, its twist on
/// <body>/twist, both on <body>/odometry, and, where asked, the transform world -> body.
class BodyPublishers {
 public:
  BodyPublishers(const ros::NodeHandle& nh, const OutputOptions& options)
      : nh_(nh),
        options_(options),
        all_(nh_.advertise<wiimote_tracker_msgs::TrackedBodyArray>("bodies", 100)) {}

  /// Advertises the topics of these bodies.
  void setBodies(const std::vector<body::Constellation>& bodies) {
    std::map<std::string, Topics> topics;
    for (const body::Constellation& body : bodies) {
      Topics& own = topics[body.name] = topics_[body.name];
      if (own.pose)
        continue;
      own.pose = nh_.advertise<geometry_msgs::PoseWithCovarianceStamped>(body.name + "/pose", 100);
      own.twist =
          nh_.advertise<geometry_msgs::TwistWithCovarianceStamped>(body.name + "/twist", 100);
      own.odometry = nh_.advertise<nav_msgs::Odometry>(body.name + "/odometry", 100);
    }
    topics_ = std::move(topics);
  }

  /// @param bridged for each body of the message, whether its topics go on while it is predicted.
  void publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
               const std::vector<bool>& bridged) {
    all_.publish(bodies);
    transforms_.clear();
    for (std::size_t i = 0; i < bodies.bodies.size(); ++i) {
      const wiimote_tracker_msgs::TrackedBody& body = bodies.bodies[i];
      const auto topics = topics_.find(body.name);
      if (topics == topics_.end() || !isPublished(body, options_.publish_predicted || bridged[i]))
        continue;
      topics->second.pose.publish(
          boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>(poseStamped(bodies, body)));
      const auto motion = boost::make_shared<nav_msgs::Odometry>(odometry(bodies, body));
      topics->second.twist.publish(
          boost::make_shared<geometry_msgs::TwistWithCovarianceStamped>(twistOf(*motion)));
      topics->second.odometry.publish(motion);
      if (options_.body_transforms)
        transforms_.push_back(transform(bodies, body));
    }
    if (!transforms_.empty())
      broadcaster_.sendTransform(transforms_);
  }

 private:
  struct Topics {
    ros::Publisher pose;
    ros::Publisher twist;
    ros::Publisher odometry;
  };

  ros::NodeHandle nh_;
  OutputOptions options_;
  ros::Publisher all_;
  std::map<std::string, Topics> topics_;  // by name
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<geometry_msgs::TransformStamped> transforms_;  // reused
};

}  // namespace wiimote_tracker
