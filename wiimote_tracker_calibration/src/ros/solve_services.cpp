#include "solve_services.h"

#include "replies.h"
#include "verdict_messages.h"

#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

namespace wiimote_tracker {

using workflow::Step;

SolveServices::SolveServices(NodeContext* context)
    : context_(*context),
      verdict_(
          context_.nh().advertise<wiimote_tracker_msgs::CalibrationVerdict>("calibration/verdict",
                                                                            1,
                                                                            true)),
      trace_(context_.nh().advertise<wiimote_tracker_msgs::PrincipalPointTrace>(
          "calibration/principal_point_trace",
          1,
          true)),
      service_(context_.nh().advertiseService("calibration/solve", &SolveServices::solve, this)) {}

bool SolveServices::solve(wiimote_tracker_msgs::SolveCalibration::Request&,
                          wiimote_tracker_msgs::SolveCalibration::Response& response) {
  Lock lock(context_.mutex());
  workflow::Calibration& calibration = context_.calibration(lock);
  session::Session session;
  workflow::Reply reply = calibration.beginSolve();
  if (reply.success) {
    reply = context_.session(&session, lock);
    if (!reply.success)
      context_.end(reply, lock);
  }
  context_.publishStatus(lock);
  fill(reply, &response);
  if (!reply.success)
    return true;
  const session::SolveOptions options = context_.parameters(lock).solve;
  lock.unlock();

  std::optional<session::Solution> solution;
  try {
    solution = session::solveSession(session, options, [this](const wave::Progress& progress) {
      const Lock inner(context_.mutex());
      context_.setProgress(progress.fraction, inner);
      return !context_.stopped(Step::kSolving, inner) && ros::ok();
    });
    solution->rig.solved_at = NodeContext::now();
    solution->rig.check();
  } catch (const geometry::Error& error) {
    solution.reset();
    reply = {false, error.what()};
  }

  lock.lock();
  if (context_.stopped(Step::kSolving, lock)) {
    solution.reset();
    reply = {false, "it was cancelled; what was captured stays"};
  }
  if (solution) {
    reply = calibration.finishSolve(solution->rig);
    solution->rig = *calibration.rig();
  } else {
    context_.end(reply, lock);
  }
  fill(reply, &response);
  if (reply.success) {
    context_.publishRig(lock);
    publish(*solution, &response);
    ROS_INFO_STREAM(reply.message);
  }
  context_.publishStatus(lock);
  return true;
}

void SolveServices::publish(const session::Solution& solution,
                            wiimote_tracker_msgs::SolveCalibration::Response* response) {
  response->rig = toMessage(solution.rig);
  response->verdict = toMessage(solution.verdict, solution.rig);
  verdict_.publish(response->verdict);
  if (solution.trace)
    trace_.publish(toMessage(*solution.trace, solution.rig));
}

}  // namespace wiimote_tracker
