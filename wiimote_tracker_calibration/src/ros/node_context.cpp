#include "node_context.h"

#include "samples/judge.h"

#include "verdict_messages.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace wiimote_tracker {

namespace {

constexpr std::chrono::milliseconds kLongestNap(100);
constexpr std::chrono::seconds kPatience(10);

/// The camera's identity, starting intrinsics and gravity.
/// @throws Refusal: the intrinsics are for another size of image, or the images have none.
square::CameraSightings factsOf(const std::string& name,
                                const CameraInput& input,
                                const Parameters& parameters) {
  const geometry::Intrinsics& lens = parameters.intrinsicsOf(name);
  if (input.width == 0 || input.height == 0)
    throw Refusal("the images of " + name + " have no size: repair its driver");
  if (input.width > 0 && (input.width != lens.width || input.height != lens.height))
    throw Refusal("the images of " + name + " are " + std::to_string(input.width) + " x " +
                  std::to_string(input.height) + ", but its starting intrinsics are for " +
                  std::to_string(lens.width) + " x " + std::to_string(lens.height) + ": set " +
                  ros::this_node::getName() + "/cameras_intrinsics/" + name +
                  " for this camera, and start the node again");
  return {name, input.identity, lens, {}, {}, input.gravity.mean()};
}

}  // namespace

NodeContext::NodeContext(const ros::NodeHandle& nh, const Parameters& parameters)
    : nh_(nh),
      parameters_(parameters),
      calibration_(parameters.calibration),
      rig_publisher_(
          nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, true)),
      verdict_publisher_(
          nh_.advertise<wiimote_tracker_msgs::CalibrationVerdict>("calibration/verdict", 1, true)),
      inputs_(nh_, parameters.cameras, parameters.button_remote, &mutex_, &changed_),
      status_(parameters_, calibration_, &nh_, &inputs_, &transforms_) {}

double NodeContext::now() {
  return ros::Time::now().toSec();
}

ros::WallTimer NodeContext::everyHalfSecond(const std::string& name,
                                            const std::function<void()>& call) {
  return nh_.createWallTimer(ros::WallDuration(0.5),
                             [=](const ros::WallTimerEvent&) { runCallback(name, call); });
}

void NodeContext::stop() {
  inputs_.stop();
  services_.clear();
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
  if (!reply.success && isCancelled(*lock))
    reply.message = "it was cancelled; " + job.kept;
  return reply;
}

void NodeContext::discover(Lock* lock) {
  unlocked(lock, [this] { inputs_.discover(); });
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
                     "rosparam set /use_sim_time false  and start all nodes again"
                   : "the calibration node ends";
}

void NodeContext::waitInOrder(Lock* lock, double end, const std::function<bool()>& done) {
  double time = now();
  const bool is_done = waitUntil(lock, end, [&] {
    const double before = std::exchange(time, now());
    if (done())
      return true;
    if (time < before - kUnderWay)
      throw Refusal(std::string(kTimeJumpedBack) + "try again");
    end -= std::max(0.0, before - time);  // as waitUntil()
    return false;
  });
  if (!is_done && now() < end)
    throw Refusal(whyEndedEarly());
}

void NodeContext::waitFor(double duration, Lock* lock) {
  const double start = now();
  waitInOrder(lock, start + duration, [&] {
    setProgress(std::max(0.0, (now() - start) / duration), *lock);
    return isCancelled(*lock);
  });
  requireNotCancelled(*lock);
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

samples::Samples NodeContext::samples(const Lock& lock) const {
  const bool is_live = !calibration_.isRestored();
  return calibration_.samples(
      facts(is_live ? calibration_.cameras() : std::vector<std::string>(), lock), inputs_.masks());
}

workflow::Reply NodeContext::setSamples(const samples::Samples& samples, const Lock&) {
  const workflow::Reply reply = calibration_.restore(samples);
  if (reply.success) {
    for (const wave::CameraRecording& camera : samples.recording.cameras)
      inputs_.setMasks(camera.sightings.name, camera.masks);
  }
  return reply;
}

const geometry::Rig& NodeContext::existingRig(const std::string& purpose, const Lock&) const {
  if (!calibration_.rig())
    throw Refusal("there is no rig " + purpose + ": solve or load one first");
  return *calibration_.rig();
}

geometry::Rig NodeContext::rigToChange(const std::string& purpose, const Lock& lock) const {
  const geometry::Rig& in_use = existingRig(purpose, lock);
  return calibration_.goal().value_or(in_use);
}

workflow::Reply NodeContext::withPlaces(
    const std::function<workflow::Reply(remap::MeasuredPoints& places)>& work,
    const Lock&) {
  const std::size_t dropped =
      known_places_.useRig(calibration_.rig() ? calibration_.rig()->id() : "");
  workflow::Reply reply = replyOf([&] { return work(known_places_); });
  if (dropped > 0)
    reply.message +=
        "; dropped " + counted(dropped, "place") + " measured with another calibration";
  return reply;
}

void NodeContext::requireSameRig(const std::string& id, const Lock&) const {
  if (!calibration_.rig() || calibration_.rig()->id() != id)
    throw Refusal(kReplaced);
}

void NodeContext::setRig(const geometry::Rig& rig,
                         const std::string& message,
                         const Lock& lock,
                         const std::optional<geometry::Rig>& goal) {
  calibration_.setRig(rig, message);
  calibration_.setGoal(goal);
  publishRig(samples::verdictOf(rig), lock);
  publishStatus(lock);
}

void NodeContext::publishRig(const samples::Verdict& verdict, const Lock&) {
  verdict_ = verdict;
  status_.endWalk();
  const geometry::Rig& rig = *calibration_.rig();
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

}  // namespace wiimote_tracker
