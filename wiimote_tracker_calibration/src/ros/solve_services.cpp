#include "solve_services.h"

#include "camera_facts.h"
#include "replies.h"

#include <wiimote_tracker_triangulation/ros/conversions.h>

namespace wiimote_tracker {

SolveServices::SolveServices(NodeContext* context)
    : context_(*context),
      service_(context_.nh().advertiseService("calibration/solve", &SolveServices::solve, this)) {}

bool SolveServices::solve(wiimote_tracker_msgs::SolveCalibration::Request&,
                          wiimote_tracker_msgs::SolveCalibration::Response& response) {
  const Lock lock(context_.mutex());
  workflow::Calibration& calibration = context_.calibration(lock);
  std::map<std::string, workflow::CameraFacts> facts;
  workflow::Reply reply = collectFacts(&context_, lock, &facts);
  if (!reply.success)
    calibration.note(reply.message);
  else
    reply = calibration.beginSolve();
  context_.publishStatus(lock);
  if (reply.success)
    reply = calibration.solve(facts, NodeContext::now());
  fill(reply, &response);
  if (reply.success) {
    context_.publishRig(lock);
    response.rig = toMessage(*calibration.rig());
    ROS_INFO_STREAM(reply.message);
  }
  context_.publishStatus(lock);
  return true;
}

}  // namespace wiimote_tracker
