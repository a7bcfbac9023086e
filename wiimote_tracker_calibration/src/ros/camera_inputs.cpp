#include "camera_inputs.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <tf2_eigen/tf2_eigen.h>
#include <wiimote_tracker_msgs/camera_topics.h>
#include <wiimote_tracker_msgs/text.h>

#include <set>
#include <utility>

namespace wiimote_tracker {

capture::Image imageOf(const wiimote_tracker_msgs::IrBlobArray& message) {
  capture::Image image;
  image.camera = message.camera;
  image.identity = message.identity;
  image.stamp = message.header.stamp.toSec();
  image.clock_epoch = message.clock_epoch;
  for (const wiimote_tracker_msgs::IrBlob& blob : message.blobs)
    image.spots.emplace_back(blob.x, blob.y);
  capture::removeImpossible(message.width, message.height, &image.spots);
  return image;
}

std::optional<Eigen::Vector3d> specificForceOf(const sensor_msgs::Imu& message,
                                               const std::string& optical_frame,
                                               const tf2::BufferCore& transforms) {
  // -1 marks a quantity that the sensor does not measure.
  if (message.linear_acceleration_covariance[0] < 0.0)
    return std::nullopt;
  const Eigen::Vector3d in_imu(message.linear_acceleration.x, message.linear_acceleration.y,
                               message.linear_acceleration.z);
  try {
    const Eigen::Isometry3d optical_from_imu = tf2::transformToEigen(
        transforms.lookupTransform(optical_frame, message.header.frame_id, ros::Time(0)));
    return optical_from_imu.linear() * in_imu;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

CameraInputs::CameraInputs(const ros::NodeHandle& nh,
                           const std::vector<std::string>& names,
                           const std::string& ignored,
                           std::mutex* mutex,
                           std::condition_variable* changed)
    : nh_(nh),
      discovers_(names.empty()),
      ignored_(ignored),
      mutex_(mutex),
      changed_(changed),
      spinner_(1, &queue_) {
  nh_.setCallbackQueue(&queue_);
  // No tf2_ros::TransformListener: /tf may have the stamps of a bag that is played, of which tf2
  // complains by thousands of lines.
  transforms_subscriber_ = nh_.subscribe<tf2_msgs::TFMessage>(
      "/tf_static", 100, [this](const tf2_msgs::TFMessageConstPtr& message) {
        runCallback("/tf_static", [&] {
          for (const geometry_msgs::TransformStamped& transform : message->transforms)
            transforms_.setTransform(transform, "/tf_static", true);
        });
      });
  for (const std::string& name : names)
    watch(name);
}

void CameraInputs::start() {
  discover();
  // On the global queue, so that a master that does not answer delays no image.
  if (discovers_)
    timer_ = ros::NodeHandle().createWallTimer(
        ros::WallDuration(0.5), [this](const ros::WallTimerEvent&) {
          runCallback("looking for cameras", [this] { discover(); });
        });
  spinner_.start();
}

void CameraInputs::stop() {
  timer_.stop();
  spinner_.stop();
}

void CameraInputs::discover() {
  ros::master::V_TopicInfo topics;
  if (!discovers_ || !ros::master::getTopics(topics))
    return;
  std::map<std::string, std::string> types;
  for (const ros::master::TopicInfo& topic : topics)
    types[topic.name] = topic.datatype;
  const std::set<std::string> found = camerasBelow(nh_.getNamespace(), types);
  for (const std::string& camera : found) {
    if (camera != ignored_)
      watch(camera);
  }
  std::vector<std::string> watched;
  {
    const std::lock_guard<std::mutex> lock(*mutex_);
    watched = names();
  }
  for (const std::string& camera : watched) {
    if (found.count(camera) == 0 && types.count(nh_.resolveName(camera + "/ir_blobs")) > 0)
      forget(camera);
  }
}

void CameraInputs::watch(const std::string& name) {
  {
    const std::lock_guard<std::mutex> lock(*mutex_);
    if (!cameras_.emplace(name, CameraInput()).second)
      return;
  }
  const std::lock_guard<std::mutex> lock(subscribers_mutex_);
  // Capturing needs every image: the queue holds one second of them.
  std::vector<ros::Subscriber>& subscribers = subscribers_[name];
  subscribers.push_back(nh_.subscribe<wiimote_tracker_msgs::IrBlobArray>(
      name + "/ir_blobs", 100,
      [this, name](const wiimote_tracker_msgs::IrBlobArrayConstPtr& message) {
        runCallback("an image of " + name, [&] { onBlobs(name, *message); });
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  subscribers.push_back(nh_.subscribe<sensor_msgs::Imu>(
      name + "/imu/data_raw", 100, [this, name](const sensor_msgs::ImuConstPtr& message) {
        runCallback("the accelerometer of " + name, [&] { onImu(name, *message); });
      }));
}

void CameraInputs::forget(const std::string& name) {
  {
    const std::lock_guard<std::mutex> lock(subscribers_mutex_);
    subscribers_.erase(name);  // waits for its callbacks, which lock the other mutex
  }
  const std::lock_guard<std::mutex> lock(*mutex_);
  cameras_.erase(name);
}

std::vector<std::string> CameraInputs::names() const {
  std::vector<std::string> names;
  for (const auto& camera : cameras_)
    names.push_back(camera.first);
  return names;
}

std::string CameraInputs::whyIgnored(const std::vector<std::string>& cameras) const {
  std::vector<std::string> left_out;
  for (const std::string& name : cameras) {
    if (name.empty())
      continue;
    if (name == ignored_)
      return name +
             " is the button_remote, which moves when its button is pressed: calibrate the "
             "others, or set button_remote to another remote and start the node again";
    if (!discovers_ && cameras_.count(name) == 0)
      left_out.push_back(name);
  }
  if (left_out.empty())
    return "";
  return "the parameter " + ros::this_node::getName() + "/cameras names " + joined(names()) +
         ", but not " + joined(left_out) +
         ": correct the name, or add it there and start the calibration node again";
}

std::string CameraInputs::describeSilent(const geometry::Rig& rig) const {
  std::vector<std::string> silent, ignored;
  for (const geometry::RigCamera& camera : rig.cameras) {
    const std::string& name = camera.camera.name;
    const auto input = cameras_.find(name);
    if (input == cameras_.end() || input->second.width < 0)
      (whyIgnored({name}).empty() ? silent : ignored).push_back(name);
  }
  std::string text = whyIgnored(ignored);
  if (!silent.empty())
    text += (text.empty() ? "" : "; ") + ("no image has come yet from " + joined(silent)) +
            ": check that this is the rig of your cameras, and start their drivers; one that is "
            "gone for good is removed by R in calibrate";
  return text;
}

void CameraInputs::restartGravity() {
  for (auto& camera : cameras_)
    camera.second.gravity = capture::RestGravity();
}

void CameraInputs::onBlobs(const std::string& name,
                           const wiimote_tracker_msgs::IrBlobArray& message) {
  capture::Image image = imageOf(message);
  image.camera = name;
  if (image.spots.size() < message.blobs.size())
    ROS_WARN_STREAM_THROTTLE(10.0, name << " reports spots outside its image, which are "
                                           "ignored: repair its driver");
  {
    const Lock lock(*mutex_);
    CameraInput& camera = cameras_[name];
    camera.identity = message.identity;
    camera.width = static_cast<int>(message.width);
    camera.height = static_cast<int>(message.height);
    camera.max_blobs = static_cast<int>(message.max_blobs);
    camera.optical_frame = message.header.frame_id;
    capture::applyMasks(masks_, &image);
    order_.add(std::move(image), [this, &lock](const capture::Image& next) {
      const auto from = cameras_.find(next.camera);
      if (from == cameras_.end())
        return;  // forgotten while the image waited
      from->second.monitor.add(next.stamp, next.spots, ros::Time::now().toSec());
      for (const OnImage& call : on_image_)
        call(next, lock);
    });
  }
  changed_->notify_all();
}

void CameraInputs::onImu(const std::string& name, const sensor_msgs::Imu& message) {
  const Lock lock(*mutex_);
  CameraInput& camera = cameras_[name];
  const auto specific_force = specificForceOf(message, camera.optical_frame, transforms_);
  if (!specific_force)
    return;
  camera.gravity.add(*specific_force);
  for (const OnGravity& call : on_gravity_)
    call(name, message.header.stamp.toSec(), *specific_force, lock);
}

}  // namespace wiimote_tracker
