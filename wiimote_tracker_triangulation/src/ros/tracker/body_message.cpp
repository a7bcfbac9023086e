#include "body_message.h"

#include "wiimote_tracker_triangulation/geometry/so3.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::BodyLed;
using wiimote_tracker_msgs::TrackedBody;
using wiimote_tracker_msgs::TrackedBodyArray;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

BodyLed ledMessage(const body::LedEstimate& led,
                   const std::string& label,
                   const geometry::Rig& rig) {
  BodyLed message;
  message.label = label;
  setVector(led.position, &message.position);
  for (const std::size_t camera : led.cameras)
    message.cameras.push_back(rig.cameras[camera].camera.name);
  message.residual = led.residual;
  message.deviation = led.deviation;
  message.last_observed = timeOf(led.last_observed);
  return message;
}

TrackedBody bodyMessage(const body::BodyEstimate& estimate,
                        const body::Constellation& constellation,
                        const geometry::Rig& rig,
                        double time) {
  TrackedBody message;
  message.name = constellation.name;
  message.state = estimate.lost      ? TrackedBody::LOST
                  : estimate.tracked ? TrackedBody::TRACKED
                                     : TrackedBody::PREDICTED;
  setVector(estimate.world_from_body.translation(), &message.pose.pose.position);
  setRotation(Eigen::Quaterniond(estimate.world_from_body.linear()),
              &message.pose.pose.orientation);
  setMatrix(estimate.covariance.topLeftCorner<6, 6>(), &message.pose.covariance);
  setVector(estimate.velocity, &message.twist.twist.linear);
  setVector(estimate.angular_velocity, &message.twist.twist.angular);
  setMatrix(estimate.covariance.bottomRightCorner<6, 6>(), &message.twist.covariance);
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < estimate.leds.size(); ++i) {
    const body::LedEstimate& led = estimate.leds[i];
    message.leds.push_back(ledMessage(led, constellation.labelOf(i), rig));
    if (led.cameras.empty())
      continue;
    squares += led.residual * led.residual;
    count += 1.0;
  }
  message.residual =
      count > 0.0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
  message.last_observed = timeOf(estimate.last_observed);
  message.age = time - estimate.first_seen;
  return message;
}

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
  const Eigen::Matrix3d of_rotation = matrixOf<6>(pose.covariance).bottomRightCorner<3, 3>();
  const Matrix6 covariance = by_twist * matrixOf<6>(in_world.covariance) * by_twist.transpose() +
                             by_rotation * of_rotation * by_rotation.transpose();
  geometry_msgs::TwistWithCovariance twist;
  setVector(body_from_world * linear, &twist.twist.linear);
  setVector(body_from_world * angular, &twist.twist.angular);
  setMatrix(Matrix6(0.5 * (covariance + covariance.transpose())), &twist.covariance);
  return twist;
}

}  // namespace

TrackedBodyArray bodyMessage(const body::BodySnapshot& snapshot,
                             const std::vector<body::Constellation>& constellations,
                             const geometry::Rig& rig,
                             const std::string& rig_id) {
  TrackedBodyArray message;
  message.header.stamp = timeOf(snapshot.time);
  message.header.frame_id = rig.world_frame;
  message.rig_id = rig_id;
  message.latest_arrival = timeOf(snapshot.latest_arrival);
  for (std::size_t b = 0; b < snapshot.bodies.size(); ++b) {
    if (!snapshot.bodies[b])
      continue;
    message.bodies.push_back(
        bodyMessage(*snapshot.bodies[b], constellations[b], rig, snapshot.time));
  }
  return message;
}

nav_msgs::Odometry odometry(const TrackedBodyArray& array, const TrackedBody& body) {
  nav_msgs::Odometry message;
  message.header = array.header;
  message.child_frame_id = body.name;
  message.pose = body.pose;
  message.twist = inBody(body.pose, body.twist);
  return message;
}

std::optional<body::InertialSample> inertialSample(const sensor_msgs::Imu& message,
                                                   const body::ImuMount& mount) {
  const Eigen::Matrix3d turn = mount.body_from_imu.linear();
  const body::InertialSample sample{message.header.stamp.toSec() + mount.clock_offset,
                                    turn * vectorOf(message.angular_velocity),
                                    turn * vectorOf(message.linear_acceleration)};
  const bool is_there = message.angular_velocity_covariance[0] != -1.0 &&
                        message.linear_acceleration_covariance[0] != -1.0;
  if (!is_there || !sample.rate.allFinite() || !sample.force.allFinite())
    return std::nullopt;
  return sample;
}

}  // namespace wiimote_tracker
