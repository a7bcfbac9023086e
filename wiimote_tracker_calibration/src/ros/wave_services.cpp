#include "units.h"

#include <wiimote_tracker_msgs/StartWave.h>

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
    geometry::Camera camera;
    camera.name = recording.sightings.name;
    camera.intrinsics = recording.sightings.intrinsics;
    cameras->push_back(camera);
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

/// The message's 0 means: no wand, or the usual standard deviation.
std::optional<wave::Wand> wandOf(const wiimote_tracker_msgs::StartWave::Request& request) {
  if (request.wand_length == 0.0)
    return std::nullopt;
  wave::Wand wand;
  wand.length = request.wand_length;
  if (request.wand_stddev != 0.0)
    wand.stddev = request.wand_stddev;
  return wand;
}

class WaveServices {
 public:
  explicit WaveServices(NodeContext* context)
      : context_(*context),
        services_({advertise(context_.nh(), "calibration/start_wave", &WaveServices::start, this),
                   advertise(context_.nh(), "calibration/stop_wave", &WaveServices::stop, this)}) {}

 private:
  workflow::Reply start(const wiimote_tracker_msgs::StartWave::Request& request,
                        wiimote_tracker_msgs::StartWave::Response*) {
    Lock lock(context_.mutex());
    return context_.answer(&lock, [&] {
      const session::Session captured = context_.session(lock);
      session::SolveOptions options = context_.parameters(lock).solve;
      options.correct_principal_points = false;
      std::vector<geometry::Camera> cameras;
      const bool posed =
          context_.compute(&lock, [&] { return knownCameras(captured, options, &cameras); });
      const workflow::Reply reply =
          context_.calibration(lock).beginWave(cameras, posed, wandOf(request), NodeContext::now());
      context_.publishStatus(lock);
      return reply;
    });
  }

  workflow::Reply stop() {
    const Lock lock(context_.mutex());
    const workflow::Reply reply = context_.calibration(lock).endWave();
    context_.publishStatus(lock);
    return reply;
  }

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace

Unit waveServices(NodeContext* context) {
  return std::make_shared<WaveServices>(context);
}

}  // namespace wiimote_tracker
