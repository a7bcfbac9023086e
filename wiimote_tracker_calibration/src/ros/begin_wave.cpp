#include "begin_wave.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker {

namespace {

/// The cameras of a session with their starting intrinsics, and with poses if its square determines
/// them. @returns whether they have poses.
bool knownCameras(session::Session session,
                  const session::SolveOptions& options,
                  std::vector<geometry::Camera>* cameras) {
  for (wave::CameraRecording& recording : session.recording.cameras) {
    recording.frames.clear();
    cameras->push_back(recording.sightings.camera());
  }
  session.recording.wand.reset();
  if (!session.recording.square)
    return false;
  try {
    const geometry::Rig rig = session::solveSession(session, options).rig;
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
  const session::Session captured = context->session(*lock);
  workflow::Calibration& calibration = context->calibration(*lock);
  const std::vector<std::string> names = calibration.cameras();
  const std::size_t corners = calibration.square().corners().size();
  session::SolveOptions options = context->parameters(*lock).solve;
  options.correct_principal_points = false;
  std::vector<geometry::Camera> cameras;
  const bool posed =
      context->compute(lock, [&] { return knownCameras(captured, options, &cameras); });
  if (calibration.cameras() != names || calibration.square().corners().size() != corners)
    throw Refusal("what was captured has changed meanwhile: start the wave again");
  return calibration.beginWave(cameras, posed, wand, NodeContext::now());
}

}  // namespace wiimote_tracker
