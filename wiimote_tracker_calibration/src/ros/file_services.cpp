#include "node_parts.h"

#include "file_paths.h"
#include "rig_storage.h"
#include "rooms/join_rigs.h"
#include "samples/judge.h"
#include "samples/samples_file.h"
#include "workflow/next_step.h"

#include <wiimote_tracker_msgs/JoinRig.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/LoadSamples.h>
#include <wiimote_tracker_msgs/SaveRig.h>
#include <wiimote_tracker_msgs/SaveSamples.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <algorithm>
#include <string>
#include <vector>

namespace wiimote_tracker {

using namespace wiimote_tracker_msgs;
using workflow::Reply;

namespace {

/// What to do so that a rig of this file is used after the next start, too.
std::string nextStart(const std::string& path, const Parameters& parameters) {
  if (isRigFile(path, parameters))
    return "";
  if (!describeMissingRig(parameters.rig_file).empty())
    return "; the next start is without a rig: save without a name, too";
  return "; the next start loads " + parameters.rig_file +
         ", and drivers and camera files keep its lenses: save without a name to replace them all";
}

/// The images of a rig from a file get its masks: the lamps of the room belong to the rig.
void useMasks(const geometry::Rig& rig, CameraInputs* inputs) {
  for (const geometry::RigCamera& camera : rig.cameras)
    inputs->setMasks(camera.camera.name, camera.masks);
}

/// Whether nothing was captured; known places and lengths need corners.
bool isEmpty(const wave::Recording& recording) {
  return !recording.hasFrames() && std::none_of(recording.cameras.begin(), recording.cameras.end(),
                                                [](const wave::CameraRecording& camera) {
                                                  return camera.sightings.cornersSeen() > 0;
                                                });
}

class FileServices {
 public:
  /// Loads and publishes the rig of rig_file, if there is one.
  explicit FileServices(NodeContext* context) : context_(*context) {
    {
      Lock lock(context_.mutex());
      loadLastRig(&lock);
    }
    using Self = FileServices;
    context->offer("save", &Self::save, this);
    context->offer("load", &Self::load, this);
    context->offer("save_samples", &Self::saveSamples, this);
    context->offer("load_samples", &Self::loadSamples, this);
    context->offer("join", &Self::join, this);
  }

 private:
  Reply save(SaveRig& call, Lock& lock) {
    const geometry::Rig rig = context_.rigToChange("to save", lock);
    const bool is_goal = context_.calibration(lock).goal().has_value();
    const double timeout = context_.parameters(lock).set_camera_info_timeout;
    const std::string path = call.response.path =
        rigPath(call.request.path, context_.parameters(lock));
    const bool has_lenses = isRigFile(path, context_.parameters(lock));
    const std::vector<std::string> warnings = context_.compute(&lock, [&] {
      std::vector<std::string> all = files_.save(rig, path, has_lenses);
      if (!has_lenses)
        return all;
      std::vector<geometry::Camera> cameras;
      for (const geometry::RigCamera& camera : rig.cameras)
        cameras.push_back(camera.camera);
      for (const std::string& warning : sendCameraInfo(cameras, context_.nh(), timeout))
        all.push_back(warning);
      return all;
    });
    const std::string message =
        "saved to " + path +
        (is_goal ? ": the corrected rig, which the one in use still approaches" : "") +
        (context_.calibration(lock).isUnsolved()
             ? "; the calibration under way is not in it: solve that first"
             : "") +
        nextStart(path, context_.parameters(lock)) + appendix(warnings);
    if (!warnings.empty())
      ROS_WARN_STREAM(message);
    context_.calibration(lock).saved(rig);
    return {true, message};
  }

  Reply load(LoadRig& call, Lock& lock) {
    const std::string path = call.response.path =
        rigPath(call.request.path, context_.parameters(lock));
    Reply reply = loadRig(path, &lock);
    if (!reply.success)
      return reply;
    const std::string silent = context_.inputs().describeSilent(*context_.rig(lock));
    if (!silent.empty())
      reply.message += "; " + silent;
    reply.message += nextStart(path, context_.parameters(lock));
    return reply;
  }

  Reply saveSamples(SaveSamples& call, Lock& lock) {
    const std::string path = call.response.path =
        samplesPath(call.request.path, context_.parameters(lock));
    const samples::Samples samples = context_.samples(lock);
    if (isEmpty(samples.recording))
      throw Refusal(
          "nothing was captured that could be saved: start a calibration, and capture a corner or "
          "a wave first");
    context_.compute(&lock, [&] { samples::writeSamplesFile(samples, path); });
    return {true, "what was captured is saved to " + path};
  }

  Reply loadSamples(LoadSamples& call, Lock& lock) {
    const std::string path = call.response.path =
        samplesPath(call.request.path, context_.parameters(lock));
    const samples::Samples samples =
        context_.compute(&lock, [&] { return samples::readSamplesFile(path); });
    return context_.setSamples(samples, lock);
  }

  Reply join(JoinRig& call, Lock& lock) {
    const auto work = [&](const remap::MeasuredPoints& measured) {
      context_.calibration(lock).requireIdle();
      const std::string in_use = context_.existingRig("to join", lock).id();
      const geometry::Rig second = context_.rigToChange("to join", lock);
      const std::vector<remap::KnownPoint> places = measured.points();
      const double stddev = context_.parameters(lock).solve.square.uncertainty.placement;
      const std::string path = rigPath(call.request.path, context_.parameters(lock));
      rooms::JoinedRigs joined = context_.compute(
          &lock, [&] { return rooms::joinRigs(files_.read(path), second, places, stddev); });
      context_.calibration(lock).requireIdle();
      context_.requireSameRig(in_use, lock);
      joined.rig.solved_at = NodeContext::now();
      call.response.rig = toMessage(joined.rig);
      useMasks(joined.rig, &context_.inputs());
      context_.setRig(joined.rig, joined.message, lock);
      return Reply{true, joined.message};
    };
    return context_.withPlaces(work, lock);
  }

  void loadLastRig(Lock* lock) {
    const std::string path = rigPath("", context_.parameters(*lock));
    std::string& problem = context_.whyNoRig(*lock);
    problem = describeMissingRig(path);
    if (!problem.empty()) {
      ROS_INFO_STREAM(problem);
      return;
    }
    const Reply reply = context_.show(replyOf([&] { return loadRig(path, lock); }), *lock);
    if (reply.success) {
      ROS_INFO_STREAM(path << ": " << reply.message);
    } else {
      problem = reply.message + "; the node goes on without a rig";
      ROS_ERROR_STREAM(problem);
    }
  }

  Reply loadRig(const std::string& path, Lock* lock) {
    const geometry::Rig rig = context_.compute(lock, [&] { return files_.read(path); });
    Reply reply = context_.calibration(*lock).load(rig);
    if (reply.success) {
      const std::string frame = context_.parameters(*lock).calibration.world_frame;
      if (rig.world_frame != frame)
        reply.message += "; its world frame is " + rig.world_frame + ": calibrate again to have " +
                         frame + ", as world_frame says";
      useMasks(rig, &context_.inputs());
      context_.publishRig(samples::verdictOf(rig), *lock);
    }
    return reply;
  }

  NodeContext& context_;
  RigFiles files_;
};

}  // namespace

NodePart fileServices(NodeContext* context) {
  return std::make_shared<FileServices>(context);
}

}  // namespace wiimote_tracker
