#include "inertial_message.h"

#include "wiimote_tracker_triangulation/ros/message_fields.h"

namespace wiimote_tracker {

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
