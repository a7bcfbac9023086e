#include "recalibrate_services.h"

#include "replies.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

#include <utility>

namespace wiimote_tracker {

using workflow::Step;

namespace {

constexpr double kUsual = 15.0;     // [s]
constexpr double kLongest = 300.0;  // [s]

}  // namespace

RecalibrateServices::RecalibrateServices(NodeContext* context) : context_(*context) {
  service_ = context_.nh().advertiseService("calibration/recalibrate_camera",
                                            &RecalibrateServices::recalibrate, this);
  context_.inputs().subscribeImages([this](const capture::Image& image, const Lock&) {
    if (recording_)
      recording_->images.push_back(image);
  });
  context_.inputs().subscribeGravity([this](const std::string& camera, double,
                                            const Eigen::Vector3d& specific_force, const Lock&) {
    if (recording_ && camera == recording_->camera)
      gravity_.add(specific_force);
  });
}

std::optional<recalibrate::Request> RecalibrateServices::record(const std::string& camera,
                                                                double duration,
                                                                Lock* lock) {
  gravity_ = capture::RestGravity();
  recording_.emplace();
  recording_->camera = camera;
  recording_->intrinsics = context_.parameters(*lock).intrinsicsOf(camera);
  const double start = NodeContext::now();
  const bool stopped = context_.waitUntil(lock, start + duration, [&] {
    context_.setProgress((NodeContext::now() - start) / duration, *lock);
    return context_.stopped(Step::kMeasuring, *lock);
  });
  std::optional<recalibrate::Request> recording;
  if (!stopped) {
    recording = std::move(recording_);
    recording->gravity = gravity_.mean();
    const auto input = context_.inputs().cameras().find(camera);
    if (input != context_.inputs().cameras().end())
      recording->identity = input->second.identity;
  }
  recording_.reset();
  return recording;
}

bool RecalibrateServices::recalibrate(wiimote_tracker_msgs::RecalibrateCamera::Request& request,
                                      wiimote_tracker_msgs::RecalibrateCamera::Response& response) {
  const double duration = request.duration == 0.0 ? kUsual : request.duration;
  if (!(duration > 0.0 && duration <= kLongest)) {
    response.message = "the duration must be within 0 and 300 s: correct it";
    return true;
  }
  Lock lock(context_.mutex());
  if (!context_.rig(lock) || context_.rig(lock)->find(request.camera) == nullptr) {
    response.message = context_.rig(lock)
                           ? "the rig has no camera '" + request.camera + "': name one of its own"
                           : "there is no rig: solve or load one first";
    return true;
  }
  const geometry::Rig rig = *context_.rig(lock);
  workflow::Reply reply = context_.begin(
      Step::kMeasuring,
      "wave the LED where " + request.camera + " and two other cameras or more see it", lock);
  if (reply.success) {
    const auto recording = record(request.camera, duration, &lock);
    reply = {false, "it was cancelled; the rig is as it was"};
    if (recording) {
      recalibrate::Options options;
      options.uncertainty = context_.parameters(lock).solve.square.uncertainty;
      std::optional<recalibrate::Recalibration> result;
      lock.unlock();
      try {
        result = recalibrate::recalibrateCamera(rig, *recording, options);
      } catch (const geometry::Error& error) {
        reply = {false, error.what()};
      }
      lock.lock();
      if (context_.stopped(Step::kMeasuring, lock)) {
        reply = {false, "it was cancelled; the rig is as it was"};
      } else if (result && context_.rig(lock)->id() != rig.id()) {
        reply = {false, "the rig was replaced in the meantime: solve the camera anew once more"};
      } else if (result) {
        reply = {true, result->message};
        response.moved = result->moved;
        response.turned = result->turned;
        result->rig.solved_at = NodeContext::now();
        context_.setRig(result->rig, reply.message, lock);
      }
    }
    context_.end(reply, lock);
  }
  fill(reply, &response);
  return true;
}

}  // namespace wiimote_tracker
