#ifndef WIIMOTE_TRACKER_CALIBRATION_TEST_FAKE_CAMERAS_H
#define WIIMOTE_TRACKER_CALIBRATION_TEST_FAKE_CAMERAS_H

#include "simulated_square.h"

#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <atomic>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {

/// The paper's four cameras as drivers would show them, and an LED that is carried about. camera_1
/// has an accelerometer; camera_4 offers no set_camera_info.
class FakeCameras {
 public:
  FakeCameras() {
    const auto poses = square::paperRig();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      geometry::Camera camera;
      camera.name = "camera_" + std::to_string(i + 1);
      camera.world_from_camera = poses[i];
      truth.push_back(camera);
      publishers_.push_back(
          nh_.advertise<wiimote_tracker_msgs::IrBlobArray>(camera.name + "/ir_blobs", 100));
      if (i < 3)
        services_.push_back(nh_.advertiseService<sensor_msgs::SetCameraInfo::Request,
                                                 sensor_msgs::SetCameraInfo::Response>(
            camera.name + "/set_camera_info", [this, camera](auto& request, auto& response) {
              const std::lock_guard<std::mutex> lock(mutex_);
              camera_infos_[camera.name] = request.camera_info;
              response.success = true;
              return true;
            }));
    }
    imu_ = nh_.advertise<sensor_msgs::Imu>("camera_1/imu/data_raw", 100);
    publishImuFrame();
    thread_ = std::thread([this] { run(); });
  }

  ~FakeCameras() {
    stop_ = true;
    thread_.join();
  }

  void putLed(const Eigen::Vector3d& place, double speed = 0.0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    led_ = place;
    led_speed_ = speed;
  }
  void blind(const std::set<std::string>& cameras) {
    const std::lock_guard<std::mutex> lock(mutex_);
    blind_ = cameras;
  }
  std::map<std::string, sensor_msgs::CameraInfo> cameraInfos() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return camera_infos_;
  }

  std::vector<geometry::Camera> truth;

 private:
  // The remote's own axes: left, to its back, up.
  void publishImuFrame() {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "camera_1_optical_frame";
    transform.child_frame_id = "camera_1_imu_frame";
    Eigen::Matrix3d optical_from_imu;
    optical_from_imu << -1, 0, 0, 0, 0, -1, 0, -1, 0;
    const Eigen::Quaterniond q(optical_from_imu);
    transform.transform.rotation.x = q.x();
    transform.transform.rotation.y = q.y();
    transform.transform.rotation.z = q.z();
    transform.transform.rotation.w = q.w();
    transforms_.sendTransform(transform);
  }

  void run() {
    ros::WallRate rate(200.0);
    std::mt19937 random(8);
    std::normal_distribution<double> noise(0.0, 0.1);
    while (!stop_ && ros::ok()) {
      std::set<std::string> blind;
      Eigen::Vector3d led;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        led_.x() += led_speed_ / 200.0;
        led = led_;
        blind = blind_;
      }
      for (std::size_t i = 0; i < truth.size(); ++i) {
        wiimote_tracker_msgs::IrBlobArray message;
        message.header.stamp = message.arrival = ros::Time::now();
        message.header.frame_id = truth[i].name + "_optical_frame";
        message.camera = truth[i].name;
        message.identity = "00:1e:35:00:00:0" + std::to_string(i + 1);
        message.width = 1024;
        message.height = 768;
        message.max_blobs = 4;
        if (blind.count(truth[i].name) == 0) {
          const Eigen::Vector2d pixel = truth[i].project(led).value();
          wiimote_tracker_msgs::IrBlob blob;
          blob.x = pixel.x() + noise(random);
          blob.y = pixel.y() + noise(random);
          message.blobs.push_back(blob);
        }
        publishers_[i].publish(message);
      }
      publishImu();
      rate.sleep();
    }
  }

  void publishImu() {
    const Eigen::Vector3d up = truth[0].world_from_camera.linear().row(2);  // optical frame
    sensor_msgs::Imu message;
    message.header.stamp = ros::Time::now();
    message.header.frame_id = "camera_1_imu_frame";
    message.linear_acceleration.x = -9.81 * up.x();
    message.linear_acceleration.y = -9.81 * up.z();
    message.linear_acceleration.z = -9.81 * up.y();
    imu_.publish(message);
  }

  ros::NodeHandle nh_;
  std::vector<ros::Publisher> publishers_;
  std::vector<ros::ServiceServer> services_;
  ros::Publisher imu_;
  tf2_ros::StaticTransformBroadcaster transforms_;
  mutable std::mutex mutex_;
  Eigen::Vector3d led_ = Eigen::Vector3d::Zero();
  double led_speed_ = 0.0;
  std::set<std::string> blind_;
  std::map<std::string, sensor_msgs::CameraInfo> camera_infos_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_TEST_FAKE_CAMERAS_H
