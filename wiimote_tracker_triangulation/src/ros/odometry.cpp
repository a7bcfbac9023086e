#include "odometry.h"

#include "wiimote_tracker_triangulation/geometry/so3.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <cmath>

namespace wiimote_tracker {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A twist along the world's axes to one along the body's. For small rotation errors w about the
/// world's axes, R^T v of the truth is R^T (v + [v]x w).
geometry_msgs::TwistWithCovariance inBody(const geometry_msgs::PoseWithCovariance& pose,
                                          const geometry_msgs::TwistWithCovariance& in_world) {
  const Eigen::Matrix3d body_from_world =
      rotationOf(pose.pose.orientation).toRotationMatrix().transpose();
  const Eigen::Vector3d linear = vectorOf(in_world.twist.linear);
  const Eigen::Vector3d angular = vectorOf(in_world.twist.angular);
  Eigen::Matrix<double, 6, 3> by_rotation;
  by_rotation << body_from_world * geometry::so3::skew(linear),
      body_from_world * geometry::so3::skew(angular);
  Matrix6 by_twist = Matrix6::Zero();
  by_twist.topLeftCorner<3, 3>() = body_from_world;
  by_twist.bottomRightCorner<3, 3>() = body_from_world;
  const Eigen::Matrix3d rotation = matrixOf<6>(pose.covariance).bottomRightCorner<3, 3>();
  const Matrix6 covariance = by_twist * matrixOf<6>(in_world.covariance) * by_twist.transpose() +
                             by_rotation * rotation * by_rotation.transpose();
  geometry_msgs::TwistWithCovariance twist;
  setVector(body_from_world * linear, &twist.twist.linear);
  setVector(body_from_world * angular, &twist.twist.angular);
  setMatrix(Matrix6(0.5 * (covariance + covariance.transpose())), &twist.covariance);
  return twist;
}

}  // namespace

nav_msgs::Odometry odometry(const wiimote_tracker_msgs::TrackedBodyArray& array,
                            const wiimote_tracker_msgs::TrackedBody& body) {
  nav_msgs::Odometry message;
  message.header = array.header;
  message.child_frame_id = body.name;
  message.pose = body.pose;
  message.twist = inBody(body.pose, body.twist);
  return message;
}

geometry_msgs::TwistWithCovarianceStamped twistOf(const nav_msgs::Odometry& odometry) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header = odometry.header;
  message.header.frame_id = odometry.child_frame_id;
  message.twist = odometry.twist;
  return message;
}

nav_msgs::Odometry odometry(const wiimote_tracker_msgs::TrackedPointArray& array,
                            const wiimote_tracker_msgs::TrackedPoint& point) {
  nav_msgs::Odometry message;
  message.header = array.header;
  message.child_frame_id = point.label;
  message.pose.pose.position = point.position;
  message.pose.pose.orientation.w = 1.0;
  Matrix6 covariance = kUnknownVariance * Matrix6::Identity();
  covariance.topLeftCorner<3, 3>() = matrixOf<3>(point.position_covariance);
  setMatrix(covariance, &message.pose.covariance);
  const bool has_velocity = !std::isnan(point.velocity.x);
  if (has_velocity)
    message.twist.twist.linear = point.velocity;
  covariance.topLeftCorner<3, 3>() =
      has_velocity ? matrixOf<3>(point.velocity_covariance)
                   : Eigen::Matrix3d(kUnknownVariance * Eigen::Matrix3d::Identity());
  setMatrix(covariance, &message.twist.covariance);
  return message;
}

}  // namespace wiimote_tracker
