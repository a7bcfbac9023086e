#include "units.h"

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
    const geometry::Rig rig = rigToChange(lock);
    if (!rig.find(camera))
      requireNewCamera(rig, camera, lock);
    const Job job = {Step::kMeasuring,
                     "wave the LED where " + camera + " and two other cameras or more see it",
                     "the rig is as it was", true};
    return context_.run(job, &lock, [&] {
      const recalibrate::Request recording = record(camera, duration, &lock);
      const recalibrate::Options options = context_.parameters(lock).recalibrateOptions();
      recalibrate::Recalibration result = context_.compute(
          &lock, [&] { return recalibrate::recalibrateCamera(rig, recording, options); });
      context_.requireNotCancelled(lock);
      context_.requireSameRig(in_use, lock);
      call.response.moved = result.moved;
      call.response.turned = result.turned;
      // A new camera gets the masks that its images have.
      const auto masks = context_.inputs().masks().find(camera);
      if (!rig.find(camera) && masks != context_.inputs().masks().end())
        result.rig.cameras.back().masks = masks->second;
      result.rig.solved_at = NodeContext::now();
      const std::string message = result.message + voidCorrection(rig);
      context_.setRig(result.rig, message, lock);
      return workflow::Reply{true, message};
    });
  }

  /// The rig in use, or the corrected one that it approaches.
  geometry::Rig rigToChange(const Lock& lock) const {
    const geometry::Rig& in_use = context_.existingRig("with this camera", lock);
    return context_.calibration(lock).goal().value_or(in_use);
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

  /// @throws Refusal: a camera that the rig lacks sends no images, or its starting intrinsics do
  /// not fit them.
  void requireNewCamera(const geometry::Rig& rig, const std::string& name, const Lock& lock) {
    std::set<std::string> names;
    for (const geometry::RigCamera& camera : rig.cameras)
      names.insert(camera.camera.name);
    for (const auto& [camera, input] : context_.inputs().cameras()) {
      if (input.width >= 0)
        names.insert(camera);
    }
    if (names.count(name) == 0)
      throw Refusal("the rig has no camera '" + name +
                    "', and none of that name sends images: start its driver, or name one of " +
                    joined(names));
    context_.facts({name}, lock);
  }

  workflow::Reply remove(RemoveCamera& call, Lock& lock) {
    const std::string& camera = call.request.camera;
    context_.calibration(lock).requireIdle();
    const geometry::Rig before = rigToChange(lock);
    geometry::Rig rig = recalibrate::withoutCamera(before, camera);
    // The accuracy that the verdict states was with this camera.
    const samples::Grade grade =
        std::max(samples::gradeOf(before.verdict), samples::Grade::kUsable);
    rig.verdict =
        samples::nameOf(grade) + ": " + camera + " was removed; with it: " + before.verdict;
    context_.inputs().setMasks(camera, {});  // It may stand elsewhere when it comes back.
    const std::string message = camera +
                                " was removed; save the rig, and take it out of cameras.yaml" +
                                voidCorrection(before);
    context_.setRig(rig, message, lock);
    return {true, message};
  }

  NodeContext& context_;
};

}  // namespace

Unit recalibrateServices(NodeContext* context) {
  return std::make_shared<RecalibrateServices>(context);
}

}  // namespace wiimote_tracker
