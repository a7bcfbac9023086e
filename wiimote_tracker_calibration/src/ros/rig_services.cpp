#include "rig_services.h"

#include "replies.h"
#include "rig_storage.h"

#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include <fstream>

namespace wiimote_tracker {

RigServices::RigServices(NodeContext* context) : context_(*context) {
  const std::string path = pathOr("");
  if (std::ifstream(path).good()) {
    const workflow::Reply reply = loadFile(path);
    if (reply.success)
      ROS_INFO_STREAM(path << ": " << reply.message);
    else
      ROS_ERROR_STREAM(reply.message << "; the node goes on without a rig");
  }
  services_ = {context_.nh().advertiseService("calibration/save", &RigServices::save, this),
               context_.nh().advertiseService("calibration/load", &RigServices::load, this)};
}

std::string RigServices::pathOr(const std::string& path) {
  const Lock lock(context_.mutex());
  return path.empty() ? context_.parameters(lock).rig_file : path;
}

bool RigServices::save(wiimote_tracker_msgs::SaveRig::Request& request,
                       wiimote_tracker_msgs::SaveRig::Response& response) {
  response.path = pathOr(request.path);
  std::optional<geometry::Rig> rig;
  double timeout = 0.0;
  {
    const Lock lock(context_.mutex());
    rig = context_.rig(lock);
    timeout = context_.parameters(lock).set_camera_info_timeout;
  }
  if (!rig) {
    response.message = "there is no rig to save: solve or load one first";
    return true;
  }
  // Without the lock: a driver may take its time to answer.
  std::vector<std::string> warnings;
  try {
    warnings = saveRig(*rig, response.path);
  } catch (const geometry::Error& error) {
    response.message = error.what();
    return true;
  }
  for (const std::string& warning : sendCameraInfo(*rig, context_.nh(), timeout))
    warnings.push_back(warning);
  response.success = true;
  response.message = "saved to " + response.path + joined(warnings);
  if (!warnings.empty())
    ROS_WARN_STREAM(response.message);
  const Lock lock(context_.mutex());
  context_.calibration(lock).saved(response.message);
  context_.publishStatus(lock);
  return true;
}

bool RigServices::load(wiimote_tracker_msgs::LoadRig::Request& request,
                       wiimote_tracker_msgs::LoadRig::Response& response) {
  response.path = pathOr(request.path);
  fill(loadFile(response.path), &response);
  return true;
}

workflow::Reply RigServices::loadFile(const std::string& path) {
  std::optional<geometry::Rig> rig;
  workflow::Reply reply;
  try {
    rig = geometry::readRigFile(path);
  } catch (const geometry::Error& error) {
    reply.message = error.what();
  }
  const Lock lock(context_.mutex());
  if (!rig) {
    context_.show(reply.message, lock);
    return reply;
  }
  reply = context_.calibration(lock).load(*rig);
  if (reply.success) {
    // Lamps are where they were when the rig was made.
    capture::Masks masks = context_.inputs().masks();
    for (const geometry::RigCamera& camera : rig->cameras)
      masks[camera.camera.name] = camera.masks;
    context_.inputs().setMasks(masks);
    context_.publishRig(lock);
  }
  context_.publishStatus(lock);
  return reply;
}

}  // namespace wiimote_tracker
