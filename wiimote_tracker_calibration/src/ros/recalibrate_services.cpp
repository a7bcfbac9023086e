#include "units.h"

#include "capture/rest_gravity.h"
#include "recalibrate/recalibrate_camera.h"

#include <wiimote_tracker_msgs/RecalibrateCamera.h>

#include <optional>
#include <string>

namespace wiimote_tracker {

using wiimote_tracker_msgs::RecalibrateCamera;
using workflow::Step;

namespace {

constexpr double kUsualDuration = 15.0;     // [s]
constexpr double kLongestDuration = 300.0;  // [s]

class RecalibrateServices {
 public:
  explicit RecalibrateServices(NodeContext* context) : context_(*context) {
    context->offer("recalibrate_camera", &RecalibrateServices::recalibrate, this);
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

 private:
  workflow::Reply recalibrate(RecalibrateCamera& call, Lock& lock) {
    const std::string& camera = call.request.camera;
    const double duration = call.request.duration == 0.0 ? kUsualDuration : call.request.duration;
    if (!(duration > 0.0 && duration <= kLongestDuration))
      throw Refusal("the duration must be within 0 and 300 s: correct it");
    const geometry::Rig rig = context_.existingRig("with this camera", lock);
    recalibrate::requireCamera(rig, camera);
    const Job job = {Step::kMeasuring,
                     "wave the LED where " + camera + " and two other cameras or more see it",
                     "the rig is as it was", true};
    return context_.run(job, &lock, [&] {
      const AtEnd end{[&] { recording_.reset(); }};
      gravity_ = capture::RestGravity();
      recording_.emplace();
      recording_->camera = camera;
      recording_->intrinsics = context_.parameters(lock).intrinsicsOf(camera);
      if (!context_.waitFor(duration, Step::kMeasuring, &lock))
        return workflow::Reply{false, ""};
      recalibrate::Request recording = *recording_;
      recording_.reset();
      recording.gravity = gravity_.mean();
      const auto input = context_.inputs().cameras().find(camera);
      if (input != context_.inputs().cameras().end())
        recording.identity = input->second.identity;
      const recalibrate::Options options = context_.parameters(lock).recalibrateOptions();
      recalibrate::Recalibration result = context_.compute(
          &lock, [&] { return recalibrate::recalibrateCamera(rig, recording, options); });
      if (context_.isCancelled(Step::kMeasuring, lock))
        return workflow::Reply{false, ""};
      context_.requireSameRig(rig.id(), lock);
      call.response.moved = result.moved;
      call.response.turned = result.turned;
      result.rig.solved_at = NodeContext::now();
      context_.setRig(result.rig, result.message, lock);
      return workflow::Reply{true, result.message};
    });
  }

  NodeContext& context_;
  // While an LED is waved:
  std::optional<recalibrate::Request> recording_;
  capture::RestGravity gravity_;
};

}  // namespace

Unit recalibrateServices(NodeContext* context) {
  return std::make_shared<RecalibrateServices>(context);
}

}  // namespace wiimote_tracker
