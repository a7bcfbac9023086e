#include "node_context.h"

#include "session/judge.h"

#include "camera_status.h"
#include "square_frame.h"
#include "verdict_messages.h"

#include <std_msgs/String.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace wiimote_tracker {

namespace {

constexpr std::chrono::milliseconds kLongestNap(100);
constexpr std::chrono::seconds kPatience(10);

/// The camera's identity, starting intrinsics and gravity.
/// @throws Refusal: the intrinsics are for another size of image.
square::CameraSightings factsOf(const std::string& name,
                                const CameraInput& input,
                                const Parameters& parameters) {
  const geometry::Intrinsics& lens = parameters.intrinsicsOf(name);
  if (input.width > 0 && (input.width != lens.width || input.height != lens.height))
    throw Refusal("the images of " + name + " are " + std::to_string(input.width) + " x " +
                  std::to_string(input.height) + ", but its starting intrinsics are for " +
                  std::to_string(lens.width) + " x " + std::to_string(lens.height) + ": set " +
                  ros::this_node::getName() + "/cameras_intrinsics/" + name + " for this camera");
  return {name, input.identity, lens, {}, {}, input.gravity.mean()};
}

}  // namespace

NodeContext::NodeContext(const ros::NodeHandle& nh, const Parameters& parameters)
    : nh_(nh),
      parameters_(parameters),
      calibration_(parameters.calibration),
      status_publisher_(
          nh_.advertise<wiimote_tracker_msgs::CalibrationStatus>("calibration/status", 1, true)),
      rig_publisher_(
          nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, true)),
      verdict_publisher_(
          nh_.advertise<wiimote_tracker_msgs::CalibrationVerdict>("calibration/verdict", 1, true)),
      square_publisher_(
          nh_.advertise<geometry_msgs::PolygonStamped>("calibration/square", 1, true)),
      sound_publisher_(nh_.advertise<std_msgs::String>("calibration/sound", 10)),
      inputs_(nh_, parameters.cameras, parameters.button_remote, &mutex_, &changed_) {
  // Before a calibration, too, so that the world is a frame that others can show.
  transforms_.sendTransform(
      squareTransform(parameters.calibration.world_frame, parameters.calibration.layout));
  inputs_.subscribeImages([this](const capture::Image& image, const Lock&) {
    const CameraInput& camera = inputs_.cameras().at(image.camera);
    if (isWalked() && camera.width > 0 && camera.height > 0)
      walk_.add(image, camera.width, camera.height);
  });
}

double NodeContext::now() {
  return ros::Time::now().toSec();
}

workflow::Reply NodeContext::handle(const std::function<workflow::Reply(Lock&)>& handler) {
  Lock lock(mutex_);
  return show(replyOf([&] { return handler(lock); }), lock);
}

workflow::Reply NodeContext::run(const Job& job,
                                 Lock* lock,
                                 const std::function<workflow::Reply()>& work) {
  workflow::Reply reply = calibration_.begin(job.step, job.message, job.is_waved);
  if (!reply.success)
    return reply;
  const AtEnd end{[&] { calibration_.end(); }};
  show(reply, *lock);
  reply = replyOf(work);
  if (!reply.success && isCancelled(job.step, *lock))
    reply.message = "it was cancelled; " + job.kept;
  return reply;
}

void NodeContext::discover(Lock* lock) {
  lock->unlock();
  const AtEnd relock{[&] { lock->lock(); }};
  inputs_.discover();
}

bool NodeContext::waitUntil(Lock* lock, double end, const std::function<bool()>& done) {
  using Steady = std::chrono::steady_clock;
  fault();
  double time = now();
  Steady::time_point moved = Steady::now();
  while (!done()) {
    const double before = std::exchange(time, now());
    if (time != before)
      moved = Steady::now();
    if (time < before)
      end -= before - time;
    if (!ros::ok() || time >= end || Steady::now() - moved > kPatience)
      return false;
    changed_.wait_for(*lock, kLongestNap);
  }
  return true;
}

const char* NodeContext::whyEndedEarly() {
  return ros::ok() ? "the clock stands still: let the bag play on, or, when none is played, run  "
                     "rosparam set use_sim_time false  and start all nodes again"
                   : "the calibration node ends";
}

bool NodeContext::waitFor(double duration, workflow::Step step, Lock* lock) {
  const double start = now();
  return !waitUntil(lock, start + duration, [&] {
    setProgress(std::max(0.0, (now() - start) / duration), *lock);
    return isCancelled(step, *lock);
  });
}

workflow::Reply NodeContext::show(const workflow::Reply& reply, const Lock& lock) {
  calibration_.shown(reply);
  publishStatus(lock);
  return reply;
}

workflow::CameraFacts NodeContext::facts(const std::vector<std::string>& cameras,
                                         const Lock&) const {
  workflow::CameraFacts facts;
  for (const std::string& name : cameras) {
    const auto input = inputs_.cameras().find(name);
    if (input != inputs_.cameras().end())
      facts[name] = factsOf(name, input->second, parameters_);
  }
  return facts;
}

session::Session NodeContext::session(const Lock& lock) const {
  const bool is_live = !calibration_.isRestored();
  return calibration_.session(
      facts(is_live ? calibration_.cameras() : std::vector<std::string>(), lock), inputs_.masks());
}

workflow::Reply NodeContext::setSession(const session::Session& session, const Lock&) {
  const workflow::Reply reply = calibration_.restore(session);
  if (reply.success) {
    for (std::size_t i = 0; i < session.masks.size(); ++i)
      inputs_.setMasks(session.recording.cameras[i].sightings.name, session.masks[i]);
  }
  return reply;
}

const geometry::Rig& NodeContext::existingRig(const std::string& purpose, const Lock&) const {
  if (!calibration_.rig())
    throw Refusal("there is no rig " + purpose + ": solve or load one first");
  return *calibration_.rig();
}

std::string NodeContext::dropPlacesOfOtherRigs(const Lock&) {
  const std::size_t dropped =
      known_places_.useRig(calibration_.rig() ? calibration_.rig()->id() : "");
  return dropped == 0 ? ""
                      : "; " + std::to_string(dropped) +
                            " places that were measured with another calibration were dropped";
}

void NodeContext::requireSameRig(const std::string& id, const Lock&) const {
  if (!calibration_.rig() || calibration_.rig()->id() != id)
    throw Refusal(kReplaced);
}

void NodeContext::setRig(const geometry::Rig& rig, const std::string& message, const Lock& lock) {
  calibration_.setRig(rig, message);
  publishRig(session::verdictOf(rig), lock);
  publishStatus(lock);
}

void NodeContext::beginWalk(const Lock&) {
  walk_.restart();
  walk_is_wanted_ = true;
}

bool NodeContext::isWalked() const {
  return calibration_.cameras().empty() && (!calibration_.rig() || walk_is_wanted_);
}

void NodeContext::publishRig(const session::Verdict& verdict, const Lock&) {
  verdict_ = verdict;
  walk_is_wanted_ = false;
  const geometry::Rig& rig = *calibration_.rig();
  // The lamps of the room belong to the rig.
  for (const geometry::RigCamera& camera : rig.cameras)
    inputs_.setMasks(camera.camera.name, camera.masks);
  // The transforms first: whoever receives the rig finds them.
  transforms_.sendTransform(staticTransforms(rig));
  rig_publisher_.publish(toMessage(rig));
  verdict_publisher_.publish(toMessage(verdict_, rig));
}

bool NodeContext::setMasks(const capture::Masks& masks, const Lock& lock) {
  inputs_.setMasks(masks);
  const std::string before = calibration_.rig() ? calibration_.rig()->id() : "";
  if (!calibration_.setMasks(masks))
    return false;
  known_places_.renameRig(before, calibration_.rig()->id());
  publishRig(verdict_, lock);
  return true;
}

std::string NodeContext::health(const std::string& camera, const Lock&) const {
  const auto found = health_.find(camera);
  const std::string finding = found != health_.end() ? found->second : "";
  if (proposal_.first != camera || proposal_.second.empty())
    return finding;
  return finding + (finding.empty() ? "" : "; ") + proposal_.second;
}

std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> NodeContext::cameraStatus(
    double window,
    const Lock& lock) const {
  std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> cameras =
      wiimote_tracker::cameraStatus(calibration_, inputs_.cameras(), now(), window);
  for (wiimote_tracker_msgs::CalibrationCameraStatus& camera : cameras) {
    const auto masks = inputs_.masks().find(camera.name);
    if (masks != inputs_.masks().end())
      camera.masks = static_cast<std::uint32_t>(masks->second.size());
    camera.health = health(camera.name, lock);
    camera.seen_share = walk_.share(camera.name);
    camera.seen_with = walk_.seenWith(camera.name);
  }
  return cameras;
}

void NodeContext::publishStatus(const Lock& lock) {
  wiimote_tracker_msgs::CalibrationStatus status = calibrationStatus(calibration_, verdict_);
  status.header.stamp = ros::Time::now();
  status.header.frame_id = parameters_.calibration.world_frame;
  status.cameras = cameraStatus(1.0, lock);
  if (isWalked())
    status.walk = walk_.sentence();
  status_publisher_.publish(status);
  publishSquare(lock);
  publishSound(lock);
}

void NodeContext::publishSound(const Lock&) {
  std_msgs::String sound;
  sound.data = sounds_.heard(calibration_);
  if (parameters_.sounds && !sound.data.empty())
    sound_publisher_.publish(sound);
}

void NodeContext::publishSquare(const Lock&) {
  std::optional<square::SquareLayout> square = calibration_.layout();
  std::string world_frame = parameters_.calibration.world_frame;
  if (!square && calibration_.rig()) {
    square = squareOf(*calibration_.rig());
    world_frame = calibration_.rig()->world_frame;
  }
  const geometry_msgs::PolygonStamped outline = squareOutline(world_frame, square);
  if (outline == outline_)
    return;
  outline_ = outline;
  square_publisher_.publish(outline);
  if (square)
    transforms_.sendTransform(squareTransform(world_frame, *square));
}

}  // namespace wiimote_tracker
