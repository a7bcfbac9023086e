#include "sample_services.h"

#include "replies.h"
#include "wiimote_tracker_calibration/session/session_file.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker {

SampleServices::SampleServices(NodeContext* context)
    : context_(*context),
      services_(
          {context_.nh().advertiseService("calibration/save_samples", &SampleServices::save, this),
           context_.nh().advertiseService("calibration/load_samples",
                                          &SampleServices::load,
                                          this)}) {}

std::string SampleServices::pathOr(const std::string& path) {
  if (!path.empty())
    return path;
  const Lock lock(context_.mutex());
  const std::string& rig_file = context_.parameters(lock).rig_file;
  const std::size_t slash = rig_file.rfind('/');
  return (slash == std::string::npos ? "" : rig_file.substr(0, slash + 1)) + "samples.yaml";
}

bool SampleServices::save(wiimote_tracker_msgs::SaveSamples::Request& request,
                          wiimote_tracker_msgs::SaveSamples::Response& response) {
  response.path = pathOr(request.path);
  session::Session session;
  workflow::Reply reply;
  {
    const Lock lock(context_.mutex());
    reply = context_.session(&session, lock);
  }
  if (reply.success && session.recording.cameras.empty())
    reply = {false, "nothing was captured that could be saved: start a calibration first"};
  if (reply.success) {
    // Without the lock: a disk may take its time.
    try {
      session::writeSessionFile(session, response.path);
      reply.message = "what was captured is saved to " + response.path;
    } catch (const geometry::Error& error) {
      reply = {false, error.what()};
    }
  }
  fill(reply, &response);
  const Lock lock(context_.mutex());
  context_.show(reply.message, lock);
  return true;
}

bool SampleServices::load(wiimote_tracker_msgs::LoadSamples::Request& request,
                          wiimote_tracker_msgs::LoadSamples::Response& response) {
  response.path = pathOr(request.path);
  std::optional<session::Session> session;
  workflow::Reply reply;
  try {
    session = session::readSessionFile(response.path);
  } catch (const geometry::Error& error) {
    reply.message = error.what();
  }
  const Lock lock(context_.mutex());
  if (session)
    reply = context_.setSession(*session, lock);
  else
    context_.show(reply.message, lock);
  fill(reply, &response);
  return true;
}

}  // namespace wiimote_tracker
