#include "node_context.h"

#include "camera_facts.h"
#include "camera_status.h"

#include <wiimote_tracker_msgs/CalibrationStatus.h>

#include <chrono>

namespace wiimote_tracker {

namespace {

constexpr std::chrono::milliseconds kLongestNap(100);
constexpr std::chrono::seconds kPatience(10);

}  // namespace

NodeContext::NodeContext(const ros::NodeHandle& nh, const Parameters& parameters)
    : nh_(nh),
      parameters_(parameters),
      calibration_(parameters.calibration),
      status_publisher_(
          nh_.advertise<wiimote_tracker_msgs::CalibrationStatus>("calibration/status", 1, true)),
      rig_output_(nh_),
      inputs_(nh_, parameters.cameras, parameters.button_remote, &mutex_, &changed_) {}

double NodeContext::now() {
  return ros::Time::now().toSec();
}

bool NodeContext::waitUntil(Lock* lock, double end, const std::function<bool()>& done) {
  using Steady = std::chrono::steady_clock;
  double time = now();
  Steady::time_point moved = Steady::now();
  while (!done()) {
    if (now() != time) {
      time = now();
      moved = Steady::now();
    }
    if (!ros::ok() || time >= end || Steady::now() - moved > kPatience)
      return false;
    changed_.wait_for(*lock, kLongestNap);
  }
  return true;
}

workflow::Reply NodeContext::begin(workflow::Step step,
                                   const std::string& message,
                                   const Lock& lock) {
  const workflow::Reply reply = calibration_.begin(step, message);
  publishStatus(lock);
  return reply;
}

void NodeContext::end(const workflow::Reply& outcome, const Lock& lock) {
  calibration_.end(outcome);
  publishStatus(lock);
}

void NodeContext::show(const std::string& message, const Lock& lock) {
  calibration_.note(message);
  publishStatus(lock);
}

workflow::Reply NodeContext::session(session::Session* session, const Lock&) {
  std::map<std::string, workflow::CameraFacts> facts;
  if (!calibration_.isRestored()) {
    const workflow::Reply reply =
        collectFacts(calibration_.cameras(), inputs_.cameras(), parameters_, &facts);
    if (!reply.success)
      return reply;
  }
  *session = calibration_.session(facts, inputs_.masks());
  return {true, ""};
}

workflow::Reply NodeContext::setSession(const session::Session& session, const Lock& lock) {
  const workflow::Reply reply = calibration_.restore(session);
  if (reply.success) {
    capture::Masks masks = inputs_.masks();
    for (std::size_t i = 0; i < session.masks.size(); ++i)
      masks[session.recording.cameras[i].sightings.name] = session.masks[i];
    inputs_.setMasks(masks);
  }
  publishStatus(lock);
  return reply;
}

void NodeContext::setRig(const geometry::Rig& rig, const std::string& message, const Lock& lock) {
  calibration_.setRig(rig, message);
  publishRig(lock);
  publishStatus(lock);
}

bool NodeContext::setMasks(const capture::Masks& masks, const Lock& lock) {
  inputs_.setMasks(masks);
  if (!calibration_.setMasks(masks))
    return false;
  publishRig(lock);
  return true;
}

void NodeContext::setHealth(const std::string& camera, const std::string& text, const Lock&) {
  health_[camera] = text;
}

std::vector<wiimote_tracker_msgs::CalibrationCameraStatus>
NodeContext::cameraStatus(double now, double window, const Lock&) const {
  std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> cameras =
      wiimote_tracker::cameraStatus(calibration_, inputs_.cameras(), now, window);
  for (wiimote_tracker_msgs::CalibrationCameraStatus& camera : cameras) {
    const auto masks = inputs_.masks().find(camera.name);
    if (masks != inputs_.masks().end())
      camera.masks = static_cast<std::uint32_t>(masks->second.size());
    const auto health = health_.find(camera.name);
    if (health != health_.end())
      camera.health = health->second;
  }
  return cameras;
}

void NodeContext::publishStatus(const Lock& lock) {
  wiimote_tracker_msgs::CalibrationStatus status = calibrationStatus(calibration_);
  status.header.stamp = ros::Time::now();
  status.header.frame_id = parameters_.calibration.world_frame;
  status.cameras = cameraStatus(now(), 1.0, lock);
  status_publisher_.publish(status);
}

}  // namespace wiimote_tracker
