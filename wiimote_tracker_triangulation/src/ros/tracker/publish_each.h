#pragma once

#include "body_message.h"
#include "parameters.h"
#include "point_message.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker {

inline geometry_msgs::PointStamped pointStamped(const nav_msgs::Odometry& odometry) {
  geometry_msgs::PointStamped message;
  message.header = odometry.header;
  message.point = odometry.pose.pose.position;
  return message;
}

inline geometry_msgs::PoseWithCovarianceStamped poseStamped(const nav_msgs::Odometry& odometry) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header = odometry.header;
  message.pose = odometry.pose;
  return message;
}

/// In its own frame.
inline geometry_msgs::TwistWithCovarianceStamped twistStamped(const nav_msgs::Odometry& odometry) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header = odometry.header;
  message.header.frame_id = odometry.child_frame_id;
  message.twist = odometry.twist;
  return message;
}

inline geometry_msgs::TransformStamped transformStamped(const nav_msgs::Odometry& odometry) {
  geometry_msgs::TransformStamped message;
  message.header = odometry.header;
  message.child_frame_id = odometry.child_frame_id;
  setVector(vectorOf(odometry.pose.pose.position), &message.transform.translation);
  message.transform.rotation = odometry.pose.pose.orientation;
  return message;
}

/// Publishes each LED by itself: <label>/point and, where asked, <label>/odometry.
/// @param publish takes a topic and its message.
/// @returns the transforms world -> label.
template <typename Publish>
std::vector<geometry_msgs::TransformStamped> publishEach(
    const wiimote_tracker_msgs::TrackedPointArray& points,
    const OutputOptions& options,
    const Publish& publish) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const wiimote_tracker_msgs::TrackedPoint& point : points.points) {
    if (!isPublished(point, options.publish_predicted))
      continue;
    const nav_msgs::Odometry motion = odometry(points, point);
    publish(point.label + "/point", pointStamped(motion));
    if (options.led_odometry)
      publish(point.label + "/odometry", motion);
    transforms.push_back(transformStamped(motion));
  }
  return transforms;
}

/// The same of bodies: <body>/pose, <body>/twist and <body>/odometry.
/// @param bridged see MessageSink.
/// @returns the transforms world -> body, where asked.
template <typename Publish>
std::vector<geometry_msgs::TransformStamped> publishEach(
    const wiimote_tracker_msgs::TrackedBodyArray& bodies,
    const std::vector<bool>& bridged,
    const OutputOptions& options,
    const Publish& publish) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (std::size_t i = 0; i < bodies.bodies.size(); ++i) {
    const wiimote_tracker_msgs::TrackedBody& body = bodies.bodies[i];
    if (!isPublished(body, options.publish_predicted || bridged[i]))
      continue;
    const nav_msgs::Odometry motion = odometry(bodies, body);
    publish(body.name + "/pose", poseStamped(motion));
    publish(body.name + "/twist", twistStamped(motion));
    publish(body.name + "/odometry", motion);
    if (options.body_transforms)
      transforms.push_back(transformStamped(motion));
  }
  return transforms;
}

}  // namespace wiimote_tracker
