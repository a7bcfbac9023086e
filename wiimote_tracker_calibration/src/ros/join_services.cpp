#include "join_services.h"

#include "replies.h"

#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <algorithm>

namespace wiimote_tracker {

JoinServices::JoinServices(NodeContext* context)
    : context_(*context),
      service_(context_.nh().advertiseService("calibration/join", &JoinServices::join, this)) {}

std::vector<session::CommonPlace> JoinServices::commonPlaces(const Lock& lock) {
  place::KnownPlaces& known = context_.knownPlaces(lock);
  known.useRig(context_.rig(lock)->id());
  std::vector<session::CommonPlace> places;
  for (const place::KnownPlace& place : known.places())
    places.push_back({place.known, place.measured,
                      context_.parameters(lock).solve.square.uncertainty.placement});
  return places;
}

bool JoinServices::join(wiimote_tracker_msgs::JoinRig::Request& request,
                        wiimote_tracker_msgs::JoinRig::Response& response) {
  std::optional<geometry::Rig> second;
  std::vector<session::CommonPlace> places;
  std::string path = request.path;
  {
    const Lock lock(context_.mutex());
    second = context_.rig(lock);
    if (second)
      places = commonPlaces(lock);
    if (path.empty())
      path = context_.parameters(lock).rig_file;
  }
  if (!second) {
    response.message = "there is no rig to join: solve or load one first";
    return true;
  }
  std::optional<session::JoinedRigs> joined;
  try {
    const geometry::Rig first = geometry::readRigFile(path);
    const bool over_cameras =
        places.empty() || std::any_of(first.cameras.begin(), first.cameras.end(),
                                      [&](const geometry::RigCamera& camera) {
                                        return second->find(camera.camera.name) != nullptr;
                                      });
    joined = over_cameras ? session::joinRigs(first, *second)
                          : session::joinRigs(first, *second, places);
    joined->rig.solved_at = NodeContext::now();
  } catch (const geometry::Error& error) {
    response.message = error.what();
  }
  const Lock lock(context_.mutex());
  if (joined && context_.rig(lock)->id() != second->id()) {
    joined.reset();
    response.message = "the rig was replaced in the meantime: join again";
  }
  if (!joined) {
    context_.show(response.message, lock);
    return true;
  }
  response.success = true;
  response.message = joined->message;
  response.rig = toMessage(joined->rig);
  context_.setRig(joined->rig, joined->message, lock);
  return true;
}

}  // namespace wiimote_tracker
