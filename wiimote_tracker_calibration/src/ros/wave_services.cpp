#include "wave_services.h"

#include "units.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/StartWave.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker {

namespace {

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

class WaveServices {
 public:
  explicit WaveServices(NodeContext* context) : context_(*context) {
    context->offer("start_wave", &WaveServices::start, this);
    context->offer("stop_wave", &WaveServices::stop, this);
  }

 private:
  workflow::Reply start(wiimote_tracker_msgs::StartWave& call, Lock& lock) {
    return beginWave(wandOf(call.request.wand_length, call.request.wand_stddev), &context_, &lock);
  }

  workflow::Reply stop(std_srvs::Trigger&, Lock& lock) {
    return context_.calibration(lock).endWave();
  }

  NodeContext& context_;
};

}  // namespace

std::optional<wave::Wand> wandOf(double length, double stddev) {
  if (length == 0.0)
    return std::nullopt;
  wave::Wand wand;
  wand.length = length;
  if (stddev != 0.0)
    wand.stddev = stddev;
  return wand;
}

workflow::Reply beginWave(const std::optional<wave::Wand>& wand, NodeContext* context, Lock* lock) {
  const samples::Samples samples = context->samples(*lock);
  workflow::Calibration& calibration = context->calibration(*lock);
  const std::vector<std::string> names = calibration.cameras();
  const std::size_t corners = calibration.square().corners().size();
  const samples::SolveOptions options = context->parameters(*lock).solve;
  std::vector<geometry::Camera> cameras;
  const bool posed =
      context->compute(lock, [&] { return knownCameras(samples.recording, options, &cameras); });
  if (calibration.cameras() != names || calibration.square().corners().size() != corners)
    throw Refusal("what was captured has changed meanwhile: start the wave again");
  return calibration.beginWave(cameras, posed, wand, NodeContext::now());
}

Unit waveServices(NodeContext* context) {
  return std::make_shared<WaveServices>(context);
}

}  // namespace wiimote_tracker
