#include "camera_inputs.h"

#include <ros/master.h>
#include <tf2_eigen/tf2_eigen.h>

#include <chrono>
#include <utility>

namespace wiimote_tracker {

namespace {

const char kSuffix[] = "/ir_blobs";

}  // namespace

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CameraInputs::CameraInputs(const ros::NodeHandle& nh,
                           const std::vector<std::string>& names,
                           std::mutex* mutex,
                           std::condition_variable* changed,
                           OnImage on_image)
    : nh_(nh),
      discovers_(names.empty()),
      mutex_(mutex),
      changed_(changed),
      on_image_(std::move(on_image)),
      listener_(transforms_) {
  for (const std::string& name : names)
    watch(name);
  if (discovers_)
    timer_ = nh_.createWallTimer(ros::WallDuration(0.5),
                                 [this](const ros::WallTimerEvent&) { discover(); });
}

void CameraInputs::discover() {
  ros::master::V_TopicInfo topics;
  if (!discovers_ || !ros::master::getTopics(topics))
    return;
  const std::string own_namespace = nh_.getNamespace() == "/" ? "/" : nh_.getNamespace() + "/";
  const std::string suffix = kSuffix;
  for (const ros::master::TopicInfo& topic : topics) {
    const std::string& name = topic.name;
    if (topic.datatype != "wiimote_tracker_msgs/IrBlobArray" || name.size() <= suffix.size() ||
        name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0 ||
        name.compare(0, own_namespace.size(), own_namespace) != 0)
      continue;
    watch(name.substr(own_namespace.size(), name.size() - suffix.size() - own_namespace.size()));
  }
}

void CameraInputs::watch(const std::string& name) {
  {
    const std::lock_guard<std::mutex> lock(*mutex_);
    if (!cameras_.emplace(name, CameraInput()).second)
      return;
  }
  const std::lock_guard<std::mutex> lock(subscribers_mutex_);
  // Capturing needs every image; a queue of a second rides out a busy computer.
  subscribers_.push_back(nh_.subscribe<wiimote_tracker_msgs::IrBlobArray>(
      name + kSuffix, 100,
      [this, name](const wiimote_tracker_msgs::IrBlobArrayConstPtr& message) {
        onBlobs(name, *message);
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  subscribers_.push_back(nh_.subscribe<sensor_msgs::Imu>(
      name + "/imu/data_raw", 100,
      [this, name](const sensor_msgs::ImuConstPtr& message) { onImu(name, *message); }));
}

void CameraInputs::restartGravity() {
  for (auto& camera : cameras_)
    camera.second.gravity = capture::RestGravity();
}

void CameraInputs::onBlobs(const std::string& name,
                           const wiimote_tracker_msgs::IrBlobArray& message) {
  capture::Blobs blobs;
  for (const wiimote_tracker_msgs::IrBlob& blob : message.blobs)
    blobs.emplace_back(blob.x, blob.y);
  const double now = steadyNow();
  {
    const std::lock_guard<std::mutex> lock(*mutex_);
    CameraInput& camera = cameras_[name];
    camera.identity = message.identity;
    camera.width = static_cast<int>(message.width);
    camera.height = static_cast<int>(message.height);
    camera.monitor.add(now, blobs);
    optical_frames_[name] = message.header.frame_id;
    on_image_(name, now, blobs);
  }
  changed_->notify_all();
}

void CameraInputs::onImu(const std::string& name, const sensor_msgs::Imu& message) {
  // -1 marks a quantity that the sensor does not measure.
  if (message.linear_acceleration_covariance[0] < 0.0)
    return;
  const std::lock_guard<std::mutex> lock(*mutex_);
  const std::string& optical_frame = optical_frames_[name];
  const Eigen::Vector3d in_imu(message.linear_acceleration.x, message.linear_acceleration.y,
                               message.linear_acceleration.z);
  try {
    const Eigen::Isometry3d optical_from_imu = tf2::transformToEigen(
        transforms_.lookupTransform(optical_frame, message.header.frame_id, ros::Time(0)));
    cameras_[name].gravity.add(optical_from_imu.linear() * in_imu);
  } catch (const tf2::TransformException&) {
    // Until the transform is there the direction of gravity stays unknown.
  }
}

}  // namespace wiimote_tracker
