#include "calibration_node.h"

#include "camera_status.h"
#include "rig_storage.h"

#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

namespace wiimote_tracker {

namespace {

using Lock = std::unique_lock<std::mutex>;

constexpr std::chrono::milliseconds kFeedbackPeriod(100);

template <typename Response>
void fill(const workflow::Reply& reply, Response* response) {
  response->success = reply.success;
  response->message = reply.message;
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += "; " + sentence;
  return text;
}

}  // namespace

CalibrationNode::CalibrationNode(const ros::NodeHandle& nh, const Parameters& parameters)
    : nh_(nh),
      parameters_(parameters),
      calibration_(parameters.calibration),
      status_publisher_(
          nh_.advertise<wiimote_tracker_msgs::CalibrationStatus>("calibration/status", 1, true)),
      rig_output_(nh_),
      inputs_(nh_,
              parameters.cameras,
              &mutex_,
              &changed_,
              [this](const std::string& camera, double now, const capture::Blobs& blobs) {
                calibration_.addImage(camera, now, blobs);
              }),
      capture_server_(
          nh_,
          "calibration/capture_corner",
          [this](const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal) {
            captureCorner(goal);
          },
          false) {
  if (std::ifstream(parameters_.rig_file).good()) {
    const workflow::Reply reply = loadFile(parameters_.rig_file);
    if (reply.success)
      ROS_INFO_STREAM(parameters_.rig_file << ": " << reply.message);
    else
      ROS_ERROR_STREAM(reply.message << "; the node goes on without a rig");
  }
  inputs_.discover();
  using Node = CalibrationNode;
  services_ = {nh_.advertiseService("calibration/check_connection", &Node::checkConnection, this),
               nh_.advertiseService("calibration/start", &Node::start, this),
               nh_.advertiseService("calibration/undo", &Node::undo, this),
               nh_.advertiseService("calibration/cancel", &Node::cancel, this),
               nh_.advertiseService("calibration/solve", &Node::solve, this),
               nh_.advertiseService("calibration/save", &Node::save, this),
               nh_.advertiseService("calibration/load", &Node::load, this)};
  capture_server_.start();
  status_timer_ = nh_.createWallTimer(ros::WallDuration(0.5), [this](const ros::WallTimerEvent&) {
    const Lock lock(mutex_);
    publishStatus();
  });
  const Lock lock(mutex_);
  publishStatus();
}

bool CalibrationNode::checkConnection(wiimote_tracker_msgs::CheckConnection::Request& request,
                                      wiimote_tracker_msgs::CheckConnection::Response& response) {
  constexpr double kLongest = capture::CameraMonitor::kMemory;
  const double duration = request.duration == 0.0 ? 1.0 : request.duration;
  if (!(duration > 0.0 && duration <= kLongest)) {
    response.message = "the duration must be within 0 and 10 s";
    return true;
  }
  inputs_.discover();
  Lock lock(mutex_);
  const double end = steadyNow() + duration;
  while (ros::ok() && steadyNow() < end)
    changed_.wait_for(lock, std::chrono::duration<double>(end - steadyNow()));
  response.cameras = cameraStatus(calibration_, inputs_.cameras(), steadyNow(), duration);
  std::string problems;
  for (const auto& camera : inputs_.cameras()) {
    const std::string problem = camera.second.monitor.view(steadyNow(), duration).problem;
    if (!problem.empty())
      problems += (problems.empty() ? "" : "; ") + camera.first + " " + problem;
  }
  if (response.cameras.empty())
    problems = "no camera is there: start the drivers";
  response.success = problems.empty();
  response.message = response.success ? "all " + std::to_string(response.cameras.size()) +
                                            " cameras see exactly one spot"
                                      : problems;
  return true;
}

bool CalibrationNode::start(wiimote_tracker_msgs::StartCalibration::Request& request,
                            wiimote_tracker_msgs::StartCalibration::Response& response) {
  inputs_.discover();
  const Lock lock(mutex_);
  const bool given = request.side_x != 0.0 || request.side_y != 0.0;
  const double side_x = given ? request.side_x : parameters_.side_length;
  const double second = given ? request.side_y : parameters_.second_side_length;
  const double side_y = second != 0.0 ? second : side_x;
  fill(noted(startWith(side_x, side_y, request.cameras)), &response);
  publishStatus();
  return true;
}

workflow::Reply CalibrationNode::startWith(double side_x,
                                           double side_y,
                                           std::vector<std::string> cameras) {
  const std::map<std::string, CameraInput>& known = inputs_.cameras();
  for (const std::string& name : cameras) {
    if (known.count(name) == 0) {
      std::string names;
      for (const auto& camera : known)
        names += (names.empty() ? "" : ", ") + camera.first;
      return {false, "there is no camera " + name + ": name some of " +
                         (names.empty() ? "none, start the drivers first" : names)};
    }
  }
  if (cameras.empty()) {
    for (const auto& camera : known)
      cameras.push_back(camera.first);
  }
  if (side_x == 0.0)
    return {false,
            "the side of the square is 0: measure it, and give side_x in the request or set " +
                ros::this_node::getName() + "/side_length, in metres"};
  const workflow::Reply reply = calibration_.start(side_x, side_y, cameras);
  if (reply.success)
    inputs_.restartGravity();
  return reply;
}

workflow::Reply CalibrationNode::noted(const workflow::Reply& reply) {
  if (!reply.success)
    calibration_.note(reply.message);
  return reply;
}

bool CalibrationNode::undo(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(mutex_);
  fill(calibration_.undo(), &response);
  publishStatus();
  return true;
}

bool CalibrationNode::cancel(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  {
    const Lock lock(mutex_);
    fill(calibration_.cancel(), &response);
    publishStatus();
  }
  changed_.notify_all();
  return true;
}

void CalibrationNode::captureCorner(const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal) {
  Lock lock(mutex_);
  wiimote_tracker_msgs::CaptureCornerResult result;
  const auto retake = goal->retake ? std::optional<std::size_t>(goal->corner) : std::nullopt;
  workflow::Reply reply = calibration_.beginCapture(retake, steadyNow());
  result.corner = static_cast<std::uint32_t>(calibration_.currentCorner());
  publishStatus();
  if (reply.success)
    reply = waitForCapture(&lock);
  fill(reply, &result);
  result.cameras = cameraStatus(calibration_, inputs_.cameras(), steadyNow());
  publishStatus();
  lock.unlock();
  if (result.success)
    capture_server_.setSucceeded(result, result.message);
  else if (capture_server_.isPreemptRequested())
    capture_server_.setPreempted(result, result.message);
  else
    capture_server_.setAborted(result, result.message);
}

workflow::Reply CalibrationNode::waitForCapture(std::unique_lock<std::mutex>* lock) {
  double next_feedback = 0.0;
  while (true) {
    if (!ros::ok() || capture_server_.isPreemptRequested())
      calibration_.abandonCapture("it was called off");
    if (!calibration_.currentCapture())  // or it was cancelled
      return {false, calibration_.message()};
    const double now = steadyNow();
    if (const auto reply = calibration_.updateCapture(now))
      return *reply;
    if (now >= next_feedback) {
      next_feedback = now + std::chrono::duration<double>(kFeedbackPeriod).count();
      wiimote_tracker_msgs::CaptureCornerFeedback feedback;
      feedback.corner = static_cast<std::uint32_t>(calibration_.currentCorner());
      feedback.progress = calibration_.progress();
      feedback.message = calibration_.currentCapture()->message();
      feedback.cameras = cameraStatus(calibration_, inputs_.cameras(), now);
      capture_server_.publishFeedback(feedback);
    }
    changed_.wait_for(*lock, kFeedbackPeriod);
  }
}

workflow::Reply CalibrationNode::collectFacts(
    std::map<std::string, workflow::CameraFacts>* facts) const {
  for (const std::string& name : calibration_.cameras()) {
    const auto found = inputs_.cameras().find(name);
    if (found == inputs_.cameras().end())
      continue;
    const CameraInput& input = found->second;
    workflow::CameraFacts fact;
    fact.identity = input.identity;
    fact.intrinsics = parameters_.intrinsicsOf(name);
    if (parameters_.use_gravity)
      fact.gravity = input.gravity.mean();
    const bool sized = input.width > 0;
    if (sized && (input.width != fact.intrinsics.width || input.height != fact.intrinsics.height))
      return {false, "the images of " + name + " are " + std::to_string(input.width) + " x " +
                         std::to_string(input.height) + ", but its starting intrinsics are for " +
                         std::to_string(fact.intrinsics.width) + " x " +
                         std::to_string(fact.intrinsics.height) + ": set " +
                         ros::this_node::getName() + "/cameras_intrinsics/" + name +
                         " for this camera"};
    (*facts)[name] = fact;
  }
  return {true, ""};
}

bool CalibrationNode::solve(wiimote_tracker_msgs::SolveCalibration::Request&,
                            wiimote_tracker_msgs::SolveCalibration::Response& response) {
  const Lock lock(mutex_);
  std::map<std::string, workflow::CameraFacts> facts;
  workflow::Reply reply = noted(collectFacts(&facts));
  if (reply.success)
    reply = calibration_.beginSolve();
  publishStatus();
  if (reply.success)
    reply = calibration_.solve(facts, ros::Time::now().toSec());
  fill(reply, &response);
  if (reply.success) {
    rig_output_.publish(*calibration_.rig());
    response.rig = toMessage(*calibration_.rig());
    ROS_INFO_STREAM(reply.message);
  }
  publishStatus();
  return true;
}

bool CalibrationNode::save(wiimote_tracker_msgs::SaveRig::Request& request,
                           wiimote_tracker_msgs::SaveRig::Response& response) {
  response.path = request.path.empty() ? parameters_.rig_file : request.path;
  std::optional<geometry::Rig> rig;
  {
    const Lock lock(mutex_);
    rig = calibration_.rig();
  }
  if (!rig) {
    response.message = "there is no rig to save: solve or load one first";
    return true;
  }
  // Without the lock: a driver may take its time to answer.
  std::vector<std::string> warnings;
  try {
    warnings = saveRig(*rig, response.path);
  } catch (const geometry::Error& error) {
    response.message = error.what();
    return true;
  }
  for (const std::string& warning : sendCameraInfo(*rig, nh_))
    warnings.push_back(warning);
  response.success = true;
  response.message = "saved to " + response.path + joined(warnings);
  if (!warnings.empty())
    ROS_WARN_STREAM(response.message);
  const Lock lock(mutex_);
  calibration_.saved(response.message);
  publishStatus();
  return true;
}

bool CalibrationNode::load(wiimote_tracker_msgs::LoadRig::Request& request,
                           wiimote_tracker_msgs::LoadRig::Response& response) {
  response.path = request.path.empty() ? parameters_.rig_file : request.path;
  fill(loadFile(response.path), &response);
  return true;
}

workflow::Reply CalibrationNode::loadFile(const std::string& path) {
  std::optional<geometry::Rig> rig;
  workflow::Reply reply;
  try {
    rig = geometry::readRigFile(path);
  } catch (const geometry::Error& error) {
    reply.message = error.what();
  }
  const Lock lock(mutex_);
  reply = rig ? calibration_.load(*rig) : noted(reply);
  if (reply.success)
    rig_output_.publish(*rig);
  publishStatus();
  return reply;
}

void CalibrationNode::publishStatus() {
  wiimote_tracker_msgs::CalibrationStatus status =
      calibrationStatus(calibration_, inputs_.cameras(), steadyNow());
  status.header.stamp = ros::Time::now();
  status.header.frame_id = parameters_.calibration.world_frame;
  status_publisher_.publish(status);
}

}  // namespace wiimote_tracker
