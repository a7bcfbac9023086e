#pragma once

#include "image_topic.h"
#include "protocol/calibration_blocks.h"

#include <ros/node_handle.h>
#include <sensor_msgs/Imu.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <array>
#include <string>

namespace wiimote_tracker::driver {

/// Publishes the accelerometer as `imu/data_raw`, and its orientation to the camera as /tf_static.
class ImuPublisher {
 public:
  /// `stddev`: standard deviation of one axis [m/s^2].
  ImuPublisher(ros::NodeHandle& nh,
               const std::string& optical_frame,
               const std::string& imu_frame,
               double stddev);

  /// `raw`: x, y, z of the remote's converter.
  void publish(const std::array<int, 3>& raw,
               const protocol::AccelerometerCalibration& calibration,
               const ros::Time& stamp);

 private:
  void publishTransform(const std::string& optical_frame);

  const std::string frame_id_;
  const double variance_;  // [m^2/s^4]
  ImageTopic<sensor_msgs::Imu> topic_;
  tf2_ros::StaticTransformBroadcaster transform_;
};

}  // namespace wiimote_tracker::driver
