#include "ros_input.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <sensor_msgs/BatteryState.h>
#include <wiimote_tracker_msgs/camera_topics.h>
#include <wiimote_tracker_msgs/log_exceptions.h>

#include <algorithm>
#include <chrono>

namespace wiimote_tracker::panel {
namespace {

const std::string kImages = "/ir_blobs";
constexpr auto kSearchPeriod = std::chrono::seconds(1);
const std::string kForgotten =
    "The ROS master was started again and does not know rviz: start rviz again, too.";
constexpr std::uint32_t kEvents = 100;  // that wait for the next poll() at most

/// What is wrong with the master, as in masterProblem().
std::string lookForMaster() {
  XmlRpc::XmlRpcValue arguments, answer, address;
  arguments[0] = arguments[1] = ros::this_node::getName();
  if (ros::master::execute("lookupNode", arguments, answer, address, false))
    return "";
  if (answer.valid())  // "unknown node"
    return kForgotten;
  return "There is no ROS master at " + ros::master::getURI() +
         ": connected nodes go on, but nothing can be requested. Start roscore, then all again.";
}

}  // namespace

RosInput::RosInput(Views* views) : views_(views) {
  nh_.setCallbackQueue(&queue_);
  thread_ = std::thread([this] { run(); });
}

RosInput::~RosInput() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    must_end_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

double RosInput::now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void RosInput::poll() {
  std::optional<std::set<std::string>> cameras;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    cameras.swap(cameras_);
  }
  if (cameras)
    views_->cameras.onTopics(*cameras, now());
  queue_.callAvailable();
}

std::string RosInput::masterProblem() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return master_problem_;
}

void RosInput::run() {
  subscribeTracker();
  std::string master_problem;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!must_end_) {
    lock.unlock();
    // What is subscribed later makes rviz known, but not what it had subscribed before.
    if (master_problem != kForgotten)
      master_problem = lookForMaster();
    const auto cameras = findCameras();
    if (cameras) {
      for (const std::string& name : *cameras)
        subscribeCamera(name);
    }
    lock.lock();
    master_problem_ = master_problem;
    if (cameras)
      cameras_ = cameras;
    changed_.wait_for(lock, kSearchPeriod, [this] { return must_end_; });
  }
}

/// Names of the cameras below our namespace that have an image topic; none when the master does not
/// answer.
std::optional<std::set<std::string>> RosInput::findCameras() const {
  XmlRpc::XmlRpcValue arguments, result, topics;
  arguments[0] = ros::this_node::getName();
  arguments[1] = "";
  if (!ros::master::execute("getPublishedTopics", arguments, result, topics, false))
    return std::nullopt;
  std::map<std::string, std::string> types;
  for (int i = 0; i < topics.size(); ++i)
    types[topics[i][0]] = std::string(topics[i][1]);
  return camerasBelow(nh_.getNamespace(), types);
}

template <class Message>
void RosInput::subscribe(
    const std::string& topic,
    std::uint32_t queue_size,
    const std::function<void(const ros::MessageEvent<const Message>&)>& callback) {
  ros::SubscribeOptions options;
  using Event = const ros::MessageEvent<const Message>&;
  // What left a callback would end rviz.
  options.initByFullCallbackType<Event>(topic, queue_size, [topic, callback](Event event) {
    logExceptions("message on " + topic, [&] { callback(event); });
  });
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  try {
    subscribers_.push_back(nh_.subscribe(options));
  } catch (const ros::Exception& error) {
    ROS_WARN(
        "The Tracker panel cannot show %s: close the display that reads it as another type (%s)",
        topic.c_str(), error.what());
  }
}

void RosInput::subscribeTracker() {
  subscribe<wiimote_tracker_msgs::CalibrationStatus>(
      "calibration/status", 1, [this](const auto& event) {
        views_->cameras.onStatus(*event.getMessage(), now());
        views_->guide.onStatus(*event.getMessage(), now());
      });
  subscribe<wiimote_tracker_msgs::CalibrationVerdict>(
      "calibration/verdict", 1,
      [this](const auto& event) { views_->guide.onVerdict(*event.getMessage()); });
  subscribe<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, [this](const auto& event) {
    views_->cameras.onRig(*event.getMessage(), now());
  });
  subscribe<wiimote_tracker_msgs::TrackedPointArray>("points", 1, [this](const auto& event) {
    views_->tracks.onPoints(*event.getMessage(), now());
  });
  subscribe<wiimote_tracker_msgs::TrackedBodyArray>("bodies", 1, [this](const auto& event) {
    views_->tracks.onBodies(*event.getMessage(), now());
  });
  subscribe<wiimote_tracker_msgs::GestureEvent>("gestures", kEvents, [this](const auto& event) {
    views_->tracks.onGesture(*event.getMessage());
  });
  subscribe<wiimote_tracker_msgs::ZoneEvent>("zone_events", kEvents, [this](const auto& event) {
    views_->tracks.onZone(*event.getMessage());
  });
  // Every part sends messages of its own.
  subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", kEvents, [this](const auto& event) {
    views_->health.onDiagnostics(*event.getMessage(), now());
    views_->cameras.onDiagnostics(*event.getMessage(), now());
  });
}

/// Of the images, the newest is enough: nothing older is drawn, and none waits.
void RosInput::subscribeCamera(const std::string& name) {
  if (!watched_.insert(name).second)
    return;
  subscribe<wiimote_tracker_msgs::IrBlobArray>(name + kImages, 1, [this, name](const auto& event) {
    const auto& message = *event.getMessage();
    // In seconds: ros::Duration throws beyond 68 years.
    const double delay = event.getReceiptTime().toSec() - message.header.stamp.toSec();
    views_->cameras.onImage(name, message, delay, now());
  });
  subscribe<sensor_msgs::BatteryState>(name + "/battery", 1, [this, name](const auto& event) {
    views_->cameras.onBattery(name, event.getMessage()->percentage, now());
  });
}

}  // namespace wiimote_tracker::panel
