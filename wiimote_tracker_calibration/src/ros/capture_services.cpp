#include "node_parts.h"

#include "capture/camera_monitor.h"
#include "capture_server.h"

#include <sensor_msgs/Joy.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/MeasureLength.h>
#include <wiimote_tracker_msgs/StartCalibration.h>
#include <wiimote_tracker_msgs/StartWave.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

using std_srvs::Trigger;
using workflow::Reply;

namespace {

constexpr double kFeedbackPeriod = 0.1;  // [s]
constexpr double kForEver = std::numeric_limits<double>::infinity();
constexpr std::size_t kButtonA = 2;  // in the driver's joy messages
// A connected remote reports its acceleration 100 times a second: enough readings take less [s].
constexpr double kAccelerometerWait = 2.0;

/// A wand as a request gives it: a length of 0 means none, a standard deviation of 0 the usual one.
std::optional<wave::Wand> wandOf(double length, double stddev) {
  if (length == 0.0)
    return std::nullopt;
  wave::Wand wand;
  wand.length = length;
  if (stddev != 0.0)
    wand.stddev = stddev;
  return wand;
}

/// The wand that a run begins with. @throws Refusal, wave::WaveError: it cannot be one.
std::optional<wave::Wand> wandOnFloor(
    const wiimote_tracker_msgs::StartCalibration::Request& request,
    const Parameters& parameters) {
  std::optional<wave::Wand> wand = wandOf(request.wand_length, request.wand_stddev);
  if (!wand)
    return wand;
  if (!request.without_square)
    throw Refusal("a wand on the floor replaces the square: ask for without_square, too");
  wand->led_height = parameters.calibration.layout.led_height;
  wand->check();
  return wand;
}

/// The cameras of a recording with their starting intrinsics, and with poses if its square
/// determines them. @returns whether they have poses.
bool knownCameras(const wave::Recording& recording,
                  const samples::SolveOptions& options,
                  std::vector<geometry::Camera>* cameras) {
  std::vector<square::CameraSightings> sightings = recording.sightings();
  for (square::CameraSightings& camera : sightings) {
    cameras->push_back(camera.camera());
    if (!options.use_gravity)
      camera.gravity.reset();
  }
  if (!recording.square)
    return false;
  try {
    const geometry::Rig rig = square::solveSquare(*recording.square, sightings, options.square).rig;
    for (geometry::Camera& camera : *cameras) {
      const geometry::RigCamera* solved = rig.find(camera.name);
      if (solved == nullptr)
        return false;
      camera = solved->camera;
    }
    return true;
  } catch (const Error&) {
    return false;  // The wave can still determine the poses.
  }
}

class CaptureServices {
 public:
  explicit CaptureServices(NodeContext* context)
      : context_(*context),
        capture_server_(context_.nh(), [this](const auto& goal) { return captureCorner(goal); }) {
    using Self = CaptureServices;
    ros::NodeHandle& nh = context_.nh();
    context->offer("check_connection", &Self::checkConnection, this);
    context->offer("start", &Self::start, this);
    context->offer("measure_length", &Self::measureLength, this);
    context->offer("start_wave", &Self::startWave, this);
    context->offer("stop_wave", &Self::stopWave, this);
    context->offer("hands_free", &Self::handsFree, this);
    context->offer("undo", &Self::undo, this);
    context->offer("cancel", &Self::cancel, this);
    context_.inputs().subscribeImages([this](const capture::Image& image, const Lock& lock) {
      workflow::Calibration& calibration = context_.calibration(lock);
      const workflow::Step before = calibration.step();
      calibration.addImage(image);
      if (calibration.step() != before)
        context_.publishStatus(lock);
    });
    const Lock lock(context_.mutex());
    const Parameters& parameters = context_.parameters(lock);
    context_.calibration(lock).setHandsFree(parameters.hands_free);
    if (!parameters.button_remote.empty())
      button_ = nh.subscribe<sensor_msgs::Joy>(
          parameters.button_remote + "/joy", 10, [this](const sensor_msgs::JoyConstPtr& message) {
            runCallback("capturing by the button", [&] { onJoy(*message); });
          });
  }

 private:
  Reply checkConnection(wiimote_tracker_msgs::CheckConnection& call, Lock& lock) {
    constexpr double kLongest = capture::CameraMonitor::kMemory;
    const double duration = call.request.duration == 0.0 ? 1.0 : call.request.duration;
    if (!(duration >= NodeContext::kShortestLook && duration <= kLongest))
      throw Refusal("the duration must be within 0.05 and 10 s");
    context_.discover(&lock);
    context_.status(lock).beginWalk();
    context_.waitUntil(&lock, NodeContext::now() + duration, [] { return false; });
    call.response.cameras = context_.status(lock).cameras(duration);
    if (call.response.cameras.empty())
      throw Refusal("no camera is there: start the drivers");
    std::vector<std::pair<std::string, std::string>> problems;
    for (const auto& [name, input] : context_.inputs().cameras()) {
      const std::string problem = input.monitor.summary(NodeContext::now(), duration).problem;
      if (!problem.empty())
        problems.emplace_back(name, problem);
    }
    if (!problems.empty())
      throw Refusal(capture::listOfProblems(problems));
    context_.calibration(lock).preparation().connection_checked = true;
    return {true, "all " + std::to_string(call.response.cameras.size()) +
                      " cameras see exactly one spot"};
  }

  Reply start(wiimote_tracker_msgs::StartCalibration& call, Lock& lock) {
    context_.discover(&lock);
    const std::vector<std::string> cameras = chooseCameras(call.request.cameras, lock);
    const Parameters& parameters = context_.parameters(lock);
    const bool given = call.request.side_x != 0.0 || call.request.side_y != 0.0;
    const double side_x = given ? call.request.side_x : parameters.side_length;
    const double second = given ? call.request.side_y : parameters.second_side_length;
    const double side_y = second != 0.0 ? second : side_x;
    if (!call.request.without_square && side_x == 0.0)
      throw Refusal(
          "the side of the square is 0: measure it, and give side_x in the request or set " +
          ros::this_node::getName() + "/side_length, in metres, and start the node again");
    const std::optional<wave::Wand> wand = wandOnFloor(call.request, parameters);
    if (wand)
      requireUp(cameras, &lock);
    context_.facts(cameras, lock);  // what cannot be solved must not drop what was captured
    workflow::Calibration& calibration = context_.calibration(lock);
    const Reply reply = call.request.without_square ? calibration.startWithoutSquare(cameras)
                                                    : calibration.start(side_x, side_y, cameras);
    if (reply.success)
      context_.inputs().restartGravity();
    if (reply.success && wand)
      return beginWave(wand, &lock);
    return reply;
  }

  /// Waits for an accelerometer of a camera at rest. @throws Refusal: there is none, or none may be
  /// used.
  void requireUp(const std::vector<std::string>& cameras, Lock* lock) {
    const auto tells_up = [this](const std::string& name) {
      const auto& inputs = context_.inputs().cameras();
      const auto camera = inputs.find(name);  // it may have been left to another tracker meanwhile
      return camera != inputs.end() && camera->second.gravity.mean().has_value();
    };
    if (!context_.parameters(*lock).solve.use_gravity)
      throw Refusal(
          ros::this_node::getName() +
          "/use_gravity is false, so that no accelerometer tells where up is: set it to "
          "true and start the node again, capture a square, or begin the wave without laying "
          "the wand on the floor");
    const bool is_known = context_.waitUntil(lock, NodeContext::now() + kAccelerometerWait, [&] {
      return std::any_of(cameras.begin(), cameras.end(), tells_up);
    });
    if (!is_known)
      throw Refusal(wave::Wand::kNoUp);
  }

  Reply measureLength(wiimote_tracker_msgs::MeasureLength& call, Lock& lock) {
    square::TapedLength taped;
    taped.from = call.request.from_corner;
    taped.to = call.request.to_corner;
    taped.length = call.request.length;
    if (call.request.stddev != 0.0)
      taped.stddev = call.request.stddev;
    return context_.calibration(lock).measureLength(
        taped, context_.parameters(lock).solve.square.uncertainty.placement);
  }

  Reply startWave(wiimote_tracker_msgs::StartWave& call, Lock& lock) {
    return beginWave(wandOf(call.request.wand_length, call.request.wand_stddev), &lock);
  }

  /// @param wand nothing: one LED is waved.
  Reply beginWave(const std::optional<wave::Wand>& wand, Lock* lock) {
    const samples::Samples samples = context_.samples(*lock);
    workflow::Calibration& calibration = context_.calibration(*lock);
    const std::vector<std::string> names = calibration.cameras();
    const std::size_t corners = calibration.square().corners().size();
    const samples::SolveOptions options = context_.parameters(*lock).solve;
    std::vector<geometry::Camera> cameras;
    const bool posed =
        context_.compute(lock, [&] { return knownCameras(samples.recording, options, &cameras); });
    if (calibration.cameras() != names || calibration.square().corners().size() != corners)
      throw Refusal("what was captured has changed meanwhile: start the wave again");
    return calibration.beginWave(cameras, posed, wand, NodeContext::now());
  }

  Reply stopWave(Trigger&, Lock& lock) { return context_.calibration(lock).endWave(); }

  Reply handsFree(std_srvs::SetBool& call, Lock& lock) {
    context_.calibration(lock).setHandsFree(call.request.data);
    return {true, call.request.data
                      ? "a corner is captured automatically when the LED is still at a new place"
                      : "corners are captured on request only"};
  }

  Reply undo(Trigger&, Lock& lock) { return context_.calibration(lock).undo(); }

  Reply cancel(Trigger&, Lock& lock) {
    const Reply reply = context_.calibration(lock).cancel();
    context_.notify();
    return reply;
  }

  CaptureServer::Result captureCorner(const CaptureServer::Goal& goal) {
    CaptureServer::Result result;
    const Reply reply = replyOf([&] {
      Lock lock(context_.mutex());
      workflow::Calibration& calibration = context_.calibration(lock);
      const auto retake = goal.retake ? std::optional<std::size_t>(goal.corner) : std::nullopt;
      Reply outcome = context_.show(calibration.beginCapture(retake, NodeContext::now()), lock);
      result.corner = static_cast<std::uint32_t>(calibration.square().currentCorner());
      if (outcome.success)
        outcome = waitForCapture(&lock);
      result.cameras = context_.status(lock).cameras(1.0);
      context_.publishStatus(lock);
      return outcome;
    });
    result.success = reply.success;
    result.message = reply.message;
    return result;
  }

  void onJoy(const sensor_msgs::Joy& message) {
    const bool pressed = message.buttons.size() > kButtonA && message.buttons[kButtonA] != 0;
    if (pressed && !button_was_pressed_) {
      const Lock lock(context_.mutex());
      context_.show(context_.calibration(lock).beginCapture(std::nullopt, NodeContext::now()),
                    lock);
    }
    button_was_pressed_ = pressed;
  }

  /// The cameras to calibrate; all when none is named.
  /// @throws Refusal: one of them is not there, or is the hand-held remote.
  std::vector<std::string> chooseCameras(const std::vector<std::string>& names, const Lock&) {
    const std::vector<std::string> known = context_.inputs().names();
    if (const std::string reason = context_.inputs().whyIgnored(names); !reason.empty())
      throw Refusal(reason);
    for (const std::string& name : names) {
      if (context_.inputs().cameras().count(name) == 0)
        throw Refusal("there is no camera '" + name + "': " +
                      (known.empty() ? "start the drivers" : "name some of " + joined(known)));
    }
    return names.empty() ? known : names;
  }

  /// Waits until the capture has ended, was preempted or cancelled.
  Reply waitForCapture(Lock* lock) {
    workflow::Calibration& calibration = context_.calibration(*lock);
    const AtEnd end{[&] { calibration.abandonCapture("an error occurred"); }};
    double next_feedback = 0.0;
    std::string why;
    const bool over = context_.waitUntil(lock, kForEver, [&] {
      const double now = NodeContext::now();
      calibration.update(now - NodeContext::kUnderWay);
      why = capture_server_.whyCancelled();
      if (!calibration.isBusyWith(workflow::Step::kCapturing) || !why.empty())
        return true;
      if (now >= next_feedback) {
        next_feedback = now + kFeedbackPeriod;
        CaptureServer::Feedback feedback;
        feedback.corner = static_cast<std::uint32_t>(calibration.square().currentCorner());
        feedback.progress = calibration.progress();
        feedback.message = calibration.square().capture()->message();
        feedback.cameras = context_.status(*lock).cameras(1.0);
        capture_server_.publishFeedback(feedback);
      }
      return false;
    });
    calibration.abandonCapture(over ? why : NodeContext::whyEndedEarly());
    return calibration.square().outcome().value_or(
        Reply{false, "another calibration was started meanwhile: capture again"});
  }

  NodeContext& context_;
  CaptureServer capture_server_;
  // The first message is latched: a button that it shows was pressed earlier.
  bool button_was_pressed_ = true;
  ros::Subscriber button_;
};

}  // namespace

NodePart captureServices(NodeContext* context) {
  return std::make_shared<CaptureServices>(context);
}

}  // namespace wiimote_tracker
