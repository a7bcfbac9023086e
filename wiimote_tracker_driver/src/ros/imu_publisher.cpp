#include "imu_publisher.h"

#include <geometry_msgs/TransformStamped.h>

#include <cmath>
#include <cstddef>

namespace wiimote_tracker::driver {
namespace {

constexpr double kStandardGravity = 9.80665;  // [m/s^2]

}  // namespace

ImuPublisher::ImuPublisher(ros::NodeHandle& nh,
                           const std::string& optical_frame,
                           const std::string& imu_frame,
                           double stddev)
    : frame_id_(imu_frame), variance_(stddev * stddev), topic_(nh, "imu/data_raw") {
  publishTransform(optical_frame);
}

void ImuPublisher::publish(const std::array<int, 3>& raw,
                           const protocol::AccelerometerCalibration& calibration,
                           const ros::Time& stamp) {
  if (!topic_.subscribed())
    return;
  const std::array<double, 3> g = calibration.toG(raw);
  const auto message = boost::make_shared<sensor_msgs::Imu>();
  message->header.stamp = stamp;
  message->header.frame_id = frame_id_;
  message->orientation_covariance[0] = -1.0;  // not measured
  message->angular_velocity_covariance[0] = -1.0;
  message->linear_acceleration.x = kStandardGravity * g[0];
  message->linear_acceleration.y = kStandardGravity * g[1];
  message->linear_acceleration.z = kStandardGravity * g[2];
  for (const std::size_t diagonal : {0u, 4u, 8u})
    message->linear_acceleration_covariance[diagonal] = variance_;
  topic_.publish(message);
}

void ImuPublisher::publishTransform(const std::string& optical_frame) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = optical_frame;
  transform.child_frame_id = frame_id_;
  // The remote's x (left), y (rear), z (up) are -x, -z, -y of the optical frame.
  transform.transform.rotation.x = 0.0;
  transform.transform.rotation.y = std::sqrt(0.5);
  transform.transform.rotation.z = -std::sqrt(0.5);
  transform.transform.rotation.w = 0.0;
  transform_.sendTransform(transform);
}

}  // namespace wiimote_tracker::driver
