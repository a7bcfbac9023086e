#include "capture_services.h"

#include "camera_status.h"
#include "replies.h"

#include <limits>

namespace wiimote_tracker {

namespace {

constexpr double kFeedbackPeriod = 0.1;  // [s]
constexpr double kForEver = std::numeric_limits<double>::infinity();

std::string buttonRemote(NodeContext* context) {
  const Lock lock(context->mutex());
  return context->parameters(lock).button_remote;
}

}  // namespace

CaptureServices::CaptureServices(NodeContext* context)
    : context_(*context),
      capture_server_(
          context->nh(),
          "calibration/capture_corner",
          [this](const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal) {
            captureCorner(goal);
          },
          false),
      button_(&context->nh(), buttonRemote(context), [this] { onButton(); }) {
  ros::NodeHandle& nh = context_.nh();
  using Unit = CaptureServices;
  services_ = {nh.advertiseService("calibration/check_connection", &Unit::checkConnection, this),
               nh.advertiseService("calibration/start", &Unit::start, this),
               nh.advertiseService("calibration/hands_free", &Unit::handsFree, this),
               nh.advertiseService("calibration/undo", &Unit::undo, this),
               nh.advertiseService("calibration/cancel", &Unit::cancel, this)};
  context_.inputs().subscribeImages([this](const capture::Image& image, const Lock& lock) {
    workflow::Calibration& calibration = context_.calibration(lock);
    const workflow::Step before = calibration.step();
    calibration.addImage(image);
    if (calibration.step() != before)
      context_.publishStatus(lock);
  });
  const Lock lock(context_.mutex());
  context_.calibration(lock).setHandsFree(context_.parameters(lock).hands_free);
  capture_server_.start();
}

bool CaptureServices::checkConnection(wiimote_tracker_msgs::CheckConnection::Request& request,
                                      wiimote_tracker_msgs::CheckConnection::Response& response) {
  constexpr double kLongest = capture::CameraMonitor::kMemory;
  const double duration = request.duration == 0.0 ? 1.0 : request.duration;
  if (!(duration > 0.0 && duration <= kLongest)) {
    response.message = "the duration must be within 0 and 10 s";
    return true;
  }
  context_.inputs().discover();
  Lock lock(context_.mutex());
  context_.waitUntil(&lock, NodeContext::now() + duration, [] { return false; });
  const double now = NodeContext::now();
  response.cameras = context_.cameraStatus(now, duration, lock);
  std::string problems;
  for (const auto& camera : context_.inputs().cameras()) {
    const std::string problem = camera.second.monitor.view(now, duration).problem;
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

bool CaptureServices::start(wiimote_tracker_msgs::StartCalibration::Request& request,
                            wiimote_tracker_msgs::StartCalibration::Response& response) {
  context_.inputs().discover();
  const Lock lock(context_.mutex());
  const workflow::Reply reply = start(request, lock);
  fill(reply, &response);
  context_.show(reply.message, lock);
  return true;
}

workflow::Reply CaptureServices::start(
    const wiimote_tracker_msgs::StartCalibration::Request& request,
    const Lock& lock) {
  std::vector<std::string> cameras = request.cameras;
  workflow::Reply reply = chooseCameras(&cameras, lock);
  if (!reply.success)
    return reply;
  const Parameters& parameters = context_.parameters(lock);
  const bool given = request.side_x != 0.0 || request.side_y != 0.0;
  const double side_x = given ? request.side_x : parameters.side_length;
  const double second = given ? request.side_y : parameters.second_side_length;
  const double side_y = second != 0.0 ? second : side_x;
  if (!request.without_square && side_x == 0.0)
    return {false,
            "the side of the square is 0: measure it, and give side_x in the request or set " +
                ros::this_node::getName() + "/side_length, in metres"};
  workflow::Calibration& calibration = context_.calibration(lock);
  reply = request.without_square ? calibration.startWithoutSquare(cameras)
                                 : calibration.start(side_x, side_y, cameras);
  if (reply.success)
    context_.inputs().restartGravity();
  return reply;
}

workflow::Reply CaptureServices::chooseCameras(std::vector<std::string>* cameras,
                                               const Lock& lock) {
  const std::map<std::string, CameraInput>& known = context_.inputs().cameras();
  for (const std::string& name : *cameras) {
    if (name == context_.parameters(lock).button_remote)
      return {false, name +
                         " is the remote whose button captures, and pressing moves it: calibrate "
                         "the others, or take another remote into the hand"};
    if (known.count(name) == 0) {
      std::string names;
      for (const auto& camera : known)
        names += (names.empty() ? "" : ", ") + camera.first;
      return {false, "there is no camera " + name + ": name some of " +
                         (names.empty() ? "none, start the drivers first" : names)};
    }
  }
  if (cameras->empty()) {
    for (const auto& camera : known)
      cameras->push_back(camera.first);
  }
  return {true, ""};
}

bool CaptureServices::handsFree(std_srvs::SetBool::Request& request,
                                std_srvs::SetBool::Response& response) {
  const Lock lock(context_.mutex());
  context_.calibration(lock).setHandsFree(request.data);
  response.success = true;
  response.message = request.data
                         ? "a corner is captured by itself when the LED is held still at a "
                           "new place"
                         : "corners are captured on request only";
  context_.show(response.message, lock);
  return true;
}

void CaptureServices::onButton() {
  const Lock lock(context_.mutex());
  context_.calibration(lock).beginCapture(std::nullopt, NodeContext::now());
  context_.publishStatus(lock);
}

bool CaptureServices::undo(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  fill(context_.calibration(lock).undo(), &response);
  context_.publishStatus(lock);
  return true;
}

bool CaptureServices::cancel(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  {
    const Lock lock(context_.mutex());
    fill(context_.calibration(lock).cancel(), &response);
    context_.publishStatus(lock);
  }
  context_.notify();
  return true;
}

void CaptureServices::captureCorner(const wiimote_tracker_msgs::CaptureCornerGoalConstPtr& goal) {
  Lock lock(context_.mutex());
  workflow::Calibration& calibration = context_.calibration(lock);
  wiimote_tracker_msgs::CaptureCornerResult result;
  const auto retake = goal->retake ? std::optional<std::size_t>(goal->corner) : std::nullopt;
  workflow::Reply reply = calibration.beginCapture(retake, NodeContext::now());
  result.corner = static_cast<std::uint32_t>(calibration.square().currentCorner());
  context_.publishStatus(lock);
  if (reply.success)
    reply = waitForCapture(&lock);
  fill(reply, &result);
  result.cameras = context_.cameraStatus(NodeContext::now(), 1.0, lock);
  context_.publishStatus(lock);
  lock.unlock();
  if (result.success)
    capture_server_.setSucceeded(result, result.message);
  else if (capture_server_.isPreemptRequested())
    capture_server_.setPreempted(result, result.message);
  else
    capture_server_.setAborted(result, result.message);
}

workflow::Reply CaptureServices::waitForCapture(Lock* lock) {
  workflow::Calibration& calibration = context_.calibration(*lock);
  double next_feedback = 0.0;
  const bool over = context_.waitUntil(lock, kForEver, [&] {
    const double now = NodeContext::now();
    calibration.update(now - NodeContext::kUnderWay);
    if (calibration.square().outcome() || capture_server_.isPreemptRequested())
      return true;
    if (now >= next_feedback) {
      next_feedback = now + kFeedbackPeriod;
      wiimote_tracker_msgs::CaptureCornerFeedback feedback;
      feedback.corner = static_cast<std::uint32_t>(calibration.square().currentCorner());
      feedback.progress = calibration.progress();
      feedback.message = calibration.square().capture()->message();
      feedback.cameras = context_.cameraStatus(now, 1.0, *lock);
      capture_server_.publishFeedback(feedback);
    }
    return false;
  });
  calibration.abandonCapture(over ? "it was called off" : "the clock stands still: no images come");
  return *calibration.square().outcome();
}

}  // namespace wiimote_tracker
