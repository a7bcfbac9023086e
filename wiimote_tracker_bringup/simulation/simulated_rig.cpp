#include "simulated_rig.h"

#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <random>
#include <thread>

namespace wiimote_tracker::simulation {
namespace {

/// A request that cannot be met.
struct Refusal : Error {
  using Error::Error;
};

/// The factory points are centred near the optical axis: within 15 px here. The true spread is
/// unknown.
virtual_wiimote::Device::Options deviceOptions(const geometry::Camera& camera, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto offset = [&] { return static_cast<int>(random() % 31) - 15; };
  const int offset_x = offset();
  const int offset_y = offset();
  const auto& intrinsics = camera.intrinsics;
  virtual_wiimote::Device::Options options;
  options.factory_points = virtual_wiimote::factoryPoints(
      intrinsics.cx + offset_x, sensorY(intrinsics, intrinsics.cy) + offset_y, random());
  return options;
}

}  // namespace

using wiimote_tracker_msgs::SetLed;

SimulatedRig::SimulatedRig(ros::NodeHandle nh,
                           const Description& description,
                           const std::string& socket_directory)
    : world_frame_(description.world_frame),
      drawings_(description.drawings),
      rig_(
          description,
          [this](std::size_t camera, const Image& image) { deliver(camera, image); },
          [this](std::size_t led, double time, const Eigen::Vector3d& position) {
            publishTruth(led, time, position);
          },
          [this](std::size_t body, double time, const Eigen::Isometry3d& pose) {
            publishBodyTruth(body, time, pose);
          }) {
  for (const CameraDescription& camera : description.cameras) {
    servers_.push_back(std::make_unique<virtual_wiimote::Server>(
        socket_directory + "/" + camera.camera.name + ".sock", camera.camera.identity,
        deviceOptions(camera.camera,
                      description.seed + static_cast<std::uint32_t>(servers_.size()))));
    cameras_.push_back(camera.camera.name);
  }
  exposures_ = nh.advertise<wiimote_tracker_msgs::IrBlobArray>("simulation/exposures", 1000);
  for (const LedDescription& led : description.leds)
    truth_.push_back(
        nh.advertise<geometry_msgs::PointStamped>("simulation/truth/" + led.name, 1000));
  for (const RigidBodyDescription& body : description.bodies)
    body_truth_.push_back(
        nh.advertise<geometry_msgs::PoseStamped>("simulation/truth/" + body.name, 1000));
  start_ = std::chrono::steady_clock::now();
  start_stamp_ = ros::Time::now();
  set_led_ = nh.advertiseService("simulation/set_led", &SimulatedRig::setLed, this);
}

void SimulatedRig::run() {
  while (ros::ok()) {
    double next;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      rig_.runUntil(now());
      next = rig_.nextEvent();
    }
    std::this_thread::sleep_until(start_ + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                               std::chrono::duration<double>(next)));
  }
}

bool SimulatedRig::setLed(SetLed::Request& request, SetLed::Response& response) {
  try {
    check(request);
    const std::lock_guard<std::mutex> lock(mutex_);
    double arrival = now();
    rig_.runUntil(arrival);
    response.message = set(request, &arrival);
    response.arrival = stamp(arrival);
    response.success = true;
  } catch (const Error& error) {
    response.message = error.what();
  }
  return true;
}

/// Does what is requested. @param time now [s]; output: when the motion arrives.
/// @returns a sentence. @throws Error: it cannot be done.
std::string SimulatedRig::set(const SetLed::Request& request, double* time) {
  if (request.led == "board" && rig_.board())
    return setBoard(request);
  if (ReflectionDescription* reflection = rig_.findReflection(request.led))
    return setReflection(request, reflection);
  if (VirtualCamera* camera = rig_.findCamera(request.led))
    return turnCamera(request, camera);
  const double begin = *time;
  const char* state = request.on ? "is there" : "is away";
  if (LedDescription* led = rig_.findLed(request.led)) {
    const std::string& holder = led->turns ? led->turns->around : led->carried_by;
    if (holder.empty())
      *time = move(request, begin, &led->motion);
    else if (request.motion != SetLed::Request::HOLD)
      throw Refusal("LED '" + request.led + "' goes where '" + holder + "' goes: move that one");
    led->lit = request.on;
    state = request.on ? "shines" : "is dark";
  } else if (PersonDescription* person = rig_.findPerson(request.led)) {
    *time = move(request, begin, &person->motion);
    person->present = request.on;
  } else if (RigidBodyDescription* body = rig_.findBody(request.led)) {
    *time = move(request, begin, &body->motion);
    body->present = request.on;
  } else {
    throw Refusal("there is no LED, person, body, camera or reflection '" + request.led +
                  "' in the rig's description");
  }
  return format("'%s' %s, arrives in %g s", request.led.c_str(), state, *time - begin);
}

/// @returns when the requested motion arrives [s].
double SimulatedRig::move(const SetLed::Request& request, double time, LedMotion* motion) const {
  const Eigen::Vector3d target(request.target.x, request.target.y, request.target.z);
  switch (request.motion) {
    case SetLed::Request::LINE:
      return motion->line(time, target, request.speed);
    case SetLed::Request::CIRCLE:
      return motion->circle(time, target, request.radius, request.speed);
    case SetLed::Request::WAVE:
      return motion->wave(time, target,
                          Eigen::Vector3d(request.box.x, request.box.y, request.box.z),
                          request.speed, request.path);
    case SetLed::Request::DRAW:
      return motion->draw(time, drawings_.at(request.drawing), target, request.speed);
    default:
      motion->hold(time);
      return time;
  }
}

std::string SimulatedRig::setReflection(const SetLed::Request& request,
                                        ReflectionDescription* reflection) const {
  if (request.motion != SetLed::Request::HOLD)
    throw Refusal("reflection '" + request.led + "' can only be switched (HOLD)");
  reflection->lit = request.on;
  return "reflection '" + request.led + (request.on ? "' shines" : "' is dark");
}

std::string SimulatedRig::turnCamera(const SetLed::Request& request, VirtualCamera* camera) const {
  if (request.motion != SetLed::Request::LINE)
    throw Refusal("camera '" + request.led + "' can only be turned to a target (LINE)");
  camera->lookAt({request.target.x, request.target.y, request.target.z});
  return "camera '" + request.led + "' looks at the target";
}

std::string SimulatedRig::setBoard(const SetLed::Request& request) {
  if (request.motion != SetLed::Request::HOLD && request.motion != SetLed::Request::SHOW)
    throw Refusal("the board can only HOLD or be shown (SHOW)");
  if (request.motion == SetLed::Request::SHOW)
    rig_.board()->show(request.path);
  rig_.board()->setLit(request.on);
  return std::string("the board ") + (request.on ? "shines" : "is dark");
}

/// @throws Refusal: the request can never be met.
void SimulatedRig::check(const SetLed::Request& request) const {
  const bool line = request.motion == SetLed::Request::LINE;
  const bool circle = request.motion == SetLed::Request::CIRCLE;
  const Eigen::Vector3d sides(request.box.x, request.box.y, request.box.z);
  const bool wave = request.motion == SetLed::Request::WAVE;
  const bool draw = request.motion == SetLed::Request::DRAW;
  if (request.motion == SetLed::Request::SHOW) {
    if (request.led != "board")
      throw Refusal("only the board can be shown (SHOW)");
    return;
  }
  if (!line && !circle && !wave && !draw && request.motion != SetLed::Request::HOLD)
    throw Refusal("motion must be HOLD, LINE, CIRCLE, WAVE or DRAW");
  if ((line || circle || wave || draw) &&
      !(std::isfinite(request.target.x) && std::isfinite(request.target.y) &&
        std::isfinite(request.target.z)))
    throw Refusal("target must be finite");
  if ((line || draw) && !(request.speed >= 0.0 && std::isfinite(request.speed)))
    throw Refusal("speed must be 0 (at once) or more");
  if ((circle || wave) && !(request.speed > 0.0 && std::isfinite(request.speed)))
    throw Refusal("speed must be more than 0");
  if (circle && !(request.radius > 0.0 && std::isfinite(request.radius)))
    throw Refusal("radius must be more than 0");
  if (wave && !(sides.minCoeff() > 0.0 && sides.allFinite()))
    throw Refusal("the sides of the box must be more than 0");
  if (draw && drawings_.count(request.drawing) == 0)
    throw Refusal("the rig's description has no drawing '" + request.drawing + "'");
}

double SimulatedRig::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

ros::Time SimulatedRig::stamp(double time) const {
  return start_stamp_ + ros::Duration(time);
}

/// Whether an image comes too late since the computer paused or has too much to do. Remotes do not
/// wait for it: their images would get lost, not old. Then all are lost until one is in time.
bool SimulatedRig::isLost(const Image& image) {
  constexpr double kLatest = 0.1;   // [s]
  constexpr double kInTime = 0.01;  // [s]
  is_late_ = now() - image.due > (is_late_ ? kInTime : kLatest);
  if (is_late_)
    ROS_WARN_THROTTLE(10.0,
                      "This computer is too busy to simulate %zu cameras, and images are lost: end "
                      "other programs, or simulate fewer cameras.",
                      cameras_.size());
  return is_late_;
}

void SimulatedRig::deliver(std::size_t camera, const Image& image) {
  if (isLost(image))
    return;
  wiimote_tracker_msgs::IrBlobArray exposure;
  exposure.header.stamp = stamp(image.exposure);
  exposure.camera = cameras_[camera];
  exposure.arrival = ros::Time::now();
  servers_[camera]->sample(image);
  exposures_.publish(exposure);
}

void SimulatedRig::publishTruth(std::size_t led, double time, const Eigen::Vector3d& position) {
  geometry_msgs::PointStamped truth;
  truth.header.stamp = stamp(time);
  truth.header.frame_id = world_frame_;
  truth.point = pointOf(position);
  truth_[led].publish(truth);
}

void SimulatedRig::publishBodyTruth(std::size_t body, double time, const Eigen::Isometry3d& pose) {
  geometry_msgs::PoseStamped truth;
  truth.header.stamp = stamp(time);
  truth.header.frame_id = world_frame_;
  truth.pose.position = pointOf(pose.translation());
  setRotation(Eigen::Quaterniond(pose.linear()), &truth.pose.orientation);
  body_truth_[body].publish(truth);
}

}  // namespace wiimote_tracker::simulation
