#include "node_parts.h"

#include "capture/rest_gravity.h"
#include "recalibrate/recalibrate_camera.h"
#include "recalibrate/rig_cameras.h"
#include "samples/grade.h"

#include <wiimote_tracker_msgs/RecalibrateCamera.h>
#include <wiimote_tracker_msgs/RemoveCamera.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <set>
#include <string>

namespace wiimote_tracker {

using wiimote_tracker_msgs::RecalibrateCamera;
using wiimote_tracker_msgs::RemoveCamera;
using workflow::Step;

namespace {

constexpr double kUsualDuration = 15.0;     // [s]
constexpr double kLongestDuration = 300.0;  // [s]

class RecalibrateServices {
 public:
  explicit RecalibrateServices(NodeContext* context) : context_(*context) {
    context->offer("recalibrate_camera", &RecalibrateServices::recalibrate, this);
    context->offer("remove_camera", &RecalibrateServices::remove, this);
  }

 private:
  workflow::Reply recalibrate(RecalibrateCamera& call, Lock& lock) {
    const std::string& camera = call.request.camera;
    const double duration = call.request.duration == 0.0 ? kUsualDuration : call.request.duration;
    if (!(duration > 0.0 && duration <= kLongestDuration))
      throw Refusal("the duration must be within 0 and 300 s: correct it");
    const std::string in_use = context_.existingRig("with this camera", lock).id();
    const geometry::Rig rig = context_.rigToChange("with this camera", lock);
    const recalibrate::Options options = context_.parameters(lock).recalibrateOptions();
    requireSolvable(rig, camera, options, lock);
    const Job job = {Step::kMeasuring,
                     "wave the LED where " + camera + " and two other cameras or more see it",
                     "the rig is as it was", true};
    return context_.run(job, &lock, [&] {
      const recalibrate::Request recording = record(camera, duration, &lock);
      recalibrate::Recalibration result = context_.compute(
          &lock, [&] { return recalibrate::recalibrateCamera(rig, recording, options); });
      context_.requireNotCancelled(lock);
      context_.requireSameRig(in_use, lock);
      call.response.moved = result.moved;
      call.response.turned = result.turned;
      result.rig.solved_at = NodeContext::now();
      const std::string message = result.message + voidCorrection(rig) +
                                  (rig.find(camera) ? recalibrate::describeOldMasks(rig, result.rig)
                                                    : maskNew(&result.rig.cameras.back()));
      context_.setRig(result.rig, message, lock);
      return workflow::Reply{true, message};
    });
  }

  /// A new camera gets the masks that its images have. @returns what to do if it has none yet.
  std::string maskNew(geometry::RigCamera* camera) const {
    const capture::Masks& masks = context_.inputs().masks();
    const auto own = masks.find(camera->camera.name);
    if (own != masks.end())
      camera->masks = own->second;
    const bool lacks_masks =
        own == masks.end() && std::any_of(masks.begin(), masks.end(),
                                          [](const auto& other) { return !other.second.empty(); });
    return lacks_masks ? "; it has no masks yet: switch the LED off, and learn the lights again"
                       : "";
  }

  /// What is said when a rig with other cameras replaces this one.
  static std::string voidCorrection(const geometry::Rig& rig) {
    return rig.remap && rig.remap->rig_id == rig.id()
               ? "; the correction of the volume no longer holds: measure the known places again"
               : "";
  }

  /// While an LED is waved.
  recalibrate::Request record(const std::string& camera, double duration, Lock* lock) {
    recalibrate::Request recording;
    capture::RestGravity gravity;
    const auto watching = context_.inputs().watch(
        [&](const capture::Image& image, const Lock&) { recording.images.push_back(image); },
        [&](const std::string& name, double, const Eigen::Vector3d& specific_force, const Lock&) {
          if (name == camera)
            gravity.add(specific_force);
        });
    context_.waitFor(duration, lock);
    recording.camera = camera;
    recording.intrinsics = context_.parameters(*lock).intrinsicsOf(camera);
    recording.gravity = gravity.mean();
    const auto input = context_.inputs().cameras().find(camera);
    if (input != context_.inputs().cameras().end())
      recording.identity = input->second.identity;
    return recording;
  }

  /// Before a person waves for nothing.
  /// @throws Refusal: whatever is seen, the camera cannot be solved, or added.
  void requireSolvable(const geometry::Rig& rig,
                       const std::string& name,
                       const recalibrate::Options& options,
                       const Lock& lock) {
    const CameraInputs& inputs = context_.inputs();
    if (const std::string reason = inputs.whyIgnored({name}); !reason.empty())
      throw Refusal(reason);
    std::set<std::string> sending;
    for (const auto& [camera, input] : inputs.cameras()) {
      if (input.monitor.summary(NodeContext::now()).problem != capture::kSendsNoImages)
        sending.insert(camera);
    }
    if (!rig.find(name))
      requireNewCamera(rig, name, sending, lock);
    else if (sending.count(name) == 0)
      throw Refusal(name + " " + capture::kSendsNoImages);
    if (const std::string reason = recalibrate::whyUnsolvable(rig, name, options); !reason.empty())
      throw Refusal(reason);
    std::vector<std::string> others;
    for (const geometry::RigCamera& each : rig.cameras) {
      if (each.camera.name != name)
        others.push_back(each.camera.name);
    }
    const std::string reason = inputs.whyIgnored(others);
    if (std::count_if(others.begin(), others.end(),
                      [&](const std::string& other) { return sending.count(other) > 0; }) < 2)
      throw Refusal("two of " + joined(others) +
                    " are to see the LED, too, but fewer send images: " +
                    (reason.empty() ? "start their drivers" : reason));
  }

  /// @param sending names of the cameras that send images.
  void requireNewCamera(const geometry::Rig& rig,
                        const std::string& name,
                        std::set<std::string> sending,
                        const Lock& lock) {
    std::vector<std::string> names = {name};
    for (const geometry::RigCamera& camera : rig.cameras)
      names.push_back(camera.camera.name);
    if (sending.count(name) == 0) {
      sending.insert(names.begin() + 1, names.end());
      throw Refusal("the rig has no camera '" + name +
                    "', and none of that name sends images: start its driver, or name one of " +
                    joined(sending));
    }
    if (const std::string clash = geometry::nameClash(names); !clash.empty())
      throw Refusal(clash);
    context_.facts({name}, lock);
  }

  workflow::Reply remove(RemoveCamera& call, Lock& lock) {
    const std::string& camera = call.request.camera;
    context_.calibration(lock).requireIdle();
    const geometry::Rig before = context_.rigToChange("with this camera", lock);
    geometry::Rig rig = recalibrate::withoutCamera(before, camera);
    // The accuracy that the verdict states was with this camera.
    const samples::Grade grade =
        std::max(samples::gradeOf(before.verdict), samples::Grade::kUsable);
    rig.verdict =
        samples::nameOf(grade) + ": " + camera + " was removed; with it: " + before.verdict;
    capture::Masks masks = context_.inputs().masks();
    masks.erase(camera);  // It may stand elsewhere when it comes back.
    context_.inputs().setMasks(masks);
    const std::string split = recalibrate::describeSplit(before, camera);
    const std::string message =
        camera + " was removed; save the rig, and take it out of cameras.yaml; " +
        geometry::opticalFrame(camera) + " stays in TF until all nodes are started again" +
        (split.empty() ? "" : "; " + split) + voidCorrection(before);
    context_.removedCameras(lock).insert(camera);
    context_.setRig(rig, message, lock);
    return {true, message};
  }

  NodeContext& context_;
};

}  // namespace

NodePart recalibrateServices(NodeContext* context) {
  return std::make_shared<RecalibrateServices>(context);
}

}  // namespace wiimote_tracker
