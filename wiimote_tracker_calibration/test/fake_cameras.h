#pragma once

#include "simulated_square.h"

#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {

/// Takes what the cameras publish.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void write(const std::string& topic,
                     const wiimote_tracker_msgs::IrBlobArray& message) = 0;
  virtual void write(const std::string& topic, const sensor_msgs::Imu& message) = 0;
};

/// The paper's four cameras as drivers would show them, and an LED that is carried or waved about,
/// beside lamps that are always there. camera_1 has an accelerometer; camera_4 offers no
/// set_camera_info.
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
              while (hangs(camera.name) && ros::ok())
                ros::WallDuration(0.01).sleep();
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
  /// Carries the LED to a place, within that time [s].
  void carryLed(const Eigen::Vector3d& place, double duration) {
    const std::lock_guard<std::mutex> lock(mutex_);
    carried_from_ = led_;
    carried_to_ = place;
    carried_at_ = ros::Time::now().toSec();
    carried_for_ = duration;
  }
  /// Waves the LED on a smooth way through the volume, from now on.
  void waveLed(bool waves) {
    const std::lock_guard<std::mutex> lock(mutex_);
    waves_ = waves;
    waved_at_ = 0.0;
  }
  /// Adds an LED that another person waves.
  void waveSecondLed(bool waves) {
    const std::lock_guard<std::mutex> lock(mutex_);
    waves_second_ = waves;
  }
  /// Adds an LED half a metre behind the other one, as seen from camera_1: the other end of a wand,
  /// which turns while it is waved.
  void holdWand(bool holds) {
    const std::lock_guard<std::mutex> lock(mutex_);
    holds_wand_ = holds;
  }
  void switchLed(bool on) {
    const std::lock_guard<std::mutex> lock(mutex_);
    led_on_ = on;
  }
  void setLamps(const std::vector<Eigen::Vector3d>& lamps) {
    const std::lock_guard<std::mutex> lock(mutex_);
    lamps_ = lamps;
  }
  /// This camera's set_camera_info does not answer; empty: all do.
  void hang(const std::string& camera) {
    const std::lock_guard<std::mutex> lock(mutex_);
    hanging_ = camera;
  }
  /// Hands all messages of the cameras on to it, too; nullptr: no more.
  void record(Recorder* recorder) {
    const std::lock_guard<std::mutex> lock(mutex_);
    recorder_ = recorder;
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
  bool hangs(const std::string& camera) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return hanging_ == camera;
  }

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
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        const ros::Time stamp = ros::Time::now();
        moveLed(stamp.toSec());
        for (std::size_t i = 0; i < truth.size(); ++i) {
          wiimote_tracker_msgs::IrBlobArray message;
          message.header.stamp = message.arrival = stamp;
          message.header.frame_id = truth[i].name + "_optical_frame";
          message.camera = truth[i].name;
          message.identity = "00:1e:35:00:00:0" + std::to_string(i + 1);
          message.width = 1024;
          message.height = 768;
          message.max_blobs = 4;
          message.clock_epoch = 1;  // they have reconnected
          std::vector<Eigen::Vector3d> lights = lamps_;
          if (led_on_ && blind_.count(truth[i].name) == 0)
            lights.push_back(led_);
          if (holds_wand_)
            lights.push_back(otherEnd(stamp.toSec()));
          if (waves_second_)
            lights.push_back(wavedAt(stamp.toSec() + 10.0));
          for (const Eigen::Vector3d& light : lights) {
            const Eigen::Vector2d pixel = truth[i].project(light).value();
            wiimote_tracker_msgs::IrBlob blob;
            blob.x = pixel.x() + noise(random);
            blob.y = pixel.y() + noise(random);
            message.blobs.push_back(blob);
          }
          publish(publishers_[i], truth[i].name + "/ir_blobs", message);
        }
        publishImu(stamp);
      }
      rate.sleep();
    }
  }

  Eigen::Vector3d otherEnd(double now) const {
    Eigen::Vector3d away = led_ - truth[0].center();
    away.z() = 0.0;
    const double turn = waves_ ? 1.9 * (now - waved_at_) : 0.0;
    return led_ +
           0.5 * (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(std::sin(turn), Eigen::Vector3d::UnitX()) * away.normalized());
  }

  void moveLed(double now) {
    led_.x() += led_speed_ / 200.0;
    if (carried_for_ > 0.0) {
      const double share = std::min(1.0, (now - carried_at_) / carried_for_);
      led_ = carried_from_ + share * (carried_to_ - carried_from_);
      if (share == 1.0)
        carried_for_ = 0.0;
    }
    if (!waves_)
      return;
    waved_at_ = waved_at_ > 0.0 ? waved_at_ : now;
    led_ = wavedAt(now);
  }

  /// From its beginning always the same way, and through the whole volume within three seconds.
  Eigen::Vector3d wavedAt(double time) const {
    const double t = time - waved_at_;
    return {1.25 + 0.9 * std::sin(2.6 * t), 1.25 + 0.9 * std::cos(3.4 * t),
            1.0 + 0.7 * std::sin(4.2 * t)};
  }

  template <typename Message>
  void publish(ros::Publisher& publisher, const std::string& topic, const Message& message) {
    if (recorder_ != nullptr)
      recorder_->write("/" + topic, message);
    publisher.publish(message);
  }

  void publishImu(const ros::Time& stamp) {
    const Eigen::Vector3d up = truth[0].world_from_camera.linear().row(2);  // optical frame
    sensor_msgs::Imu message;
    message.header.stamp = stamp;
    message.header.frame_id = "camera_1_imu_frame";
    message.linear_acceleration.x = -9.81 * up.x();
    message.linear_acceleration.y = -9.81 * up.z();
    message.linear_acceleration.z = -9.81 * up.y();
    publish(imu_, "camera_1/imu/data_raw", message);
  }

  ros::NodeHandle nh_;
  std::vector<ros::Publisher> publishers_;
  std::vector<ros::ServiceServer> services_;
  ros::Publisher imu_;
  tf2_ros::StaticTransformBroadcaster transforms_;
  mutable std::mutex mutex_;
  Eigen::Vector3d led_ = Eigen::Vector3d::Zero();
  double led_speed_ = 0.0;
  bool led_on_ = true;
  bool waves_ = false;
  bool waves_second_ = false;
  bool holds_wand_ = false;
  double waved_at_ = 0.0;  // [s]; 0: not yet
  Eigen::Vector3d carried_from_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d carried_to_ = Eigen::Vector3d::Zero();
  double carried_at_ = 0.0;   // [s]
  double carried_for_ = 0.0;  // [s]; 0: not carried
  std::vector<Eigen::Vector3d> lamps_;
  std::string hanging_;
  Recorder* recorder_ = nullptr;
  std::set<std::string> blind_;
  std::map<std::string, sensor_msgs::CameraInfo> camera_infos_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker
