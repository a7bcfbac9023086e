#include "wave_services.h"

#include "replies.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker {

namespace {

/// The cameras of a session as they start; where its square says where they stand, with poses.
/// @returns whether they have them.
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
  } catch (const geometry::Error&) {
    return false;  // the wave may tell what the corners do not
  }
}

}  // namespace

WaveServices::WaveServices(NodeContext* context) : context_(*context) {
  ros::NodeHandle& nh = context_.nh();
  services_ = {nh.advertiseService("calibration/start_wave", &WaveServices::start, this),
               nh.advertiseService("calibration/stop_wave", &WaveServices::stop, this)};
}

bool WaveServices::start(wiimote_tracker_msgs::StartWave::Request& request,
                         wiimote_tracker_msgs::StartWave::Response& response) {
  std::optional<wave::Wand> wand;
  if (request.wand_length != 0.0) {
    wand.emplace();
    wand->length = request.wand_length;
    if (request.wand_stddev != 0.0)
      wand->stddev = request.wand_stddev;
  }
  Lock lock(context_.mutex());
  session::Session captured;
  workflow::Reply reply = context_.session(&captured, lock);
  if (reply.success) {
    session::SolveOptions options = context_.parameters(lock).solve;
    options.correct_principal_points = false;
    lock.unlock();
    std::vector<geometry::Camera> cameras;
    const bool posed = knownCameras(captured, options, &cameras);
    lock.lock();
    reply = context_.calibration(lock).beginWave(cameras, posed, wand, NodeContext::now());
    context_.publishStatus(lock);
  }
  fill(reply, &response);
  return true;
}

bool WaveServices::stop(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  fill(context_.calibration(lock).endWave(), &response);
  context_.publishStatus(lock);
  return true;
}

}  // namespace wiimote_tracker
