#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_INPUTS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_INPUTS_H

#include "wiimote_tracker_calibration/capture/camera_monitor.h"
#include "wiimote_tracker_calibration/capture/rest_gravity.h"

#include <ros/node_handle.h>
#include <sensor_msgs/Imu.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Seconds of the steady clock.
double steadyNow();

/// Last known facts of one camera, and its latest images.
struct CameraInput {
  std::string identity;
  int width = 0;   ///< Image size [px]; 0 until an image came.
  int height = 0;  ///< [px]
  capture::CameraMonitor monitor;
  capture::RestGravity gravity;
};

/// Subscribes to the images and the accelerometers of all cameras, named or discovered.
class CameraInputs {
 public:
  /// Called for each image with the mutex locked.
  using OnImage =
      std::function<void(const std::string& camera, double now, const capture::Blobs& blobs)>;

  /// @param names cameras to watch; empty: every topic that ends in /ir_blobs.
  /// @param mutex guards everything this class hands out; @param changed notified at each image.
  CameraInputs(const ros::NodeHandle& nh,
               const std::vector<std::string>& names,
               std::mutex* mutex,
               std::condition_variable* changed,
               OnImage on_image);

  /// Looks for cameras that have appeared. Locks the mutex.
  void discover();

  /// Lock the mutex while you look.
  const std::map<std::string, CameraInput>& cameras() const { return cameras_; }

  /// Forgets all accelerometer readings. Lock the mutex.
  void restartGravity();

 private:
  void watch(const std::string& name);
  void onBlobs(const std::string& name, const wiimote_tracker_msgs::IrBlobArray& message);
  void onImu(const std::string& name, const sensor_msgs::Imu& message);

  ros::NodeHandle nh_;
  bool discovers_;
  std::mutex* mutex_;
  std::condition_variable* changed_;
  OnImage on_image_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  std::map<std::string, CameraInput> cameras_;
  std::map<std::string, std::string> optical_frames_;
  std::mutex subscribers_mutex_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CAMERA_INPUTS_H
