#include "node_parts.h"

#include "verdict_messages.h"

#include <wiimote_tracker_msgs/SolveCalibration.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

namespace wiimote_tracker {

using wiimote_tracker_msgs::SolveCalibration;
using workflow::Step;

namespace {

class SolveServices {
 public:
  explicit SolveServices(NodeContext* context)
      : context_(*context),
        trace_(context_.nh().advertise<wiimote_tracker_msgs::PrincipalPointTrace>(
            "calibration/principal_point_trace",
            1,
            true)) {
    context->offer("solve", &SolveServices::solve, this);
  }

 private:
  workflow::Reply solve(SolveCalibration& call, Lock& lock) {
    const Job job = {Step::kSolving, "solving", "what was captured stays"};
    return context_.run(job, &lock, [&] {
      try {
        return solveCaptured(&call, &lock);
      } catch (const Refusal&) {  // cancelled, or not possible now: nothing against the data
        throw;
      } catch (const samples::WrongCorner& error) {
        refuse({error.corner}, lock);
        throw;
      } catch (const Error&) {
        refuse({}, lock);
        throw;
      }
    });
  }

  /// Whoever cancelled meanwhile is told that, not what is wrong with the data.
  void refuse(const workflow::RefusedSolution& refused, const Lock& lock) {
    if (!context_.isCancelled(lock))
      context_.calibration(lock).refuseSolution(refused);
  }

  workflow::Reply solveCaptured(SolveCalibration* call, Lock* lock) {
    const samples::Samples samples = context_.samples(*lock);
    const samples::SolveOptions options = context_.parameters(*lock).solve;
    samples::Solution solution = context_.compute(lock, [&] {
      return samples::solveSamples(samples, options, [this](const std::string&, double fraction) {
        const Lock inner(context_.mutex());
        context_.setProgress(fraction, inner);
        if (context_.isCancelled(inner) || !ros::ok())
          throw Refusal("the calibration was cancelled: nothing was changed");
      });
    });
    context_.requireNotCancelled(*lock);
    solution.rig.solved_at = NodeContext::now();
    const workflow::Reply reply = context_.calibration(*lock).takeSolution(solution.rig);
    const geometry::Rig& rig = *context_.rig(*lock);
    call->response.rig = toMessage(rig);
    call->response.verdict = toMessage(solution.verdict, rig);
    context_.publishRig(solution.verdict, *lock);
    if (solution.trace)
      trace_.publish(toMessage(*solution.trace, rig));
    ROS_INFO_STREAM(reply.message);
    return reply;
  }

  NodeContext& context_;
  ros::Publisher trace_;
};

}  // namespace

NodePart solveServices(NodeContext* context) {
  return std::make_shared<SolveServices>(context);
}

}  // namespace wiimote_tracker
