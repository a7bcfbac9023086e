#ifndef WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_H
#define WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_H

#include "driver_parameters.h"
#include "wiimote_tracker_driver/wiimote/stream_statistics.h"
#include "wiimote_tracker_driver/wiimote/wiimote.h"

#include <camera_info_manager/camera_info_manager.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace wiimote_tracker::driver {

/// Publishes one Wii Remote as an infrared blob camera with an accelerometer, as long as it lives;
/// a remote that is not there is waited for. Reads and publishes in a thread of its own.
class Driver {
 public:
  /// Starts at once. `nh`: the camera's namespace.
  /// @throws ParameterError for a configuration that can never work.
  Driver(ros::NodeHandle nh, const ros::NodeHandle& private_nh);

  /// Switches the remote's reporting, camera and LEDs off.
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

 private:
  void run();
  void publishImage(const protocol::DataReport& image, const ros::Time& arrival);
  void publishBlobs(const protocol::DataReport& image,
                    const ros::Time& stamp,
                    const ros::Time& arrival);
  void publishCameraInfo(const ros::Time& stamp);
  void publishAcceleration(const std::array<int, 3>& raw, const ros::Time& stamp);
  void publishStaticTransform();
  void linkChanged();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const DriverParameters parameters_;
  const std::string optical_frame_;
  const std::string imu_frame_;

  ros::Publisher blobs_;
  ros::Publisher camera_info_publisher_;
  ros::Publisher imu_;
  camera_info_manager::CameraInfoManager camera_info_;
  tf2_ros::StaticTransformBroadcaster transform_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer diagnostics_;

  // Of the reader thread alone.
  wiimote::Wiimote wiimote_;
  std::uint64_t frame_ = 0;
  std::string logged_error_;
  double logged_at_;

  std::mutex mutex_;  // guards what follows
  wiimote::Link link_;
  wiimote::StreamStatistics statistics_;
  bool stop_ = false;

  std::condition_variable stopping_;
  std::thread reader_;
};

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_H
