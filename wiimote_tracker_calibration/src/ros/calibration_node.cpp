#include "calibration_node.h"

#include <string>
#include <utility>

namespace wiimote_tracker {

CalibrationNode::CalibrationNode(const ros::NodeHandle& nh, const Parameters& parameters)
    : context_(nh, parameters),
      units_({fileServices(&context_), captureServices(&context_), waveServices(&context_),
              maskServices(&context_), solveServices(&context_), boardServices(&context_),
              placeServices(&context_), recalibrateServices(&context_),
              continuousServices(&context_), healthMonitor(&context_)}) {
  context_.inputs().start();
  status_timer_ =
      context_.nh().createWallTimer(ros::WallDuration(0.5), [this](const ros::WallTimerEvent&) {
        runCallback("the status", [this] {
          const Lock lock(context_.mutex());
          endCaptureOfOtherTime(lock);
          context_.calibration(lock).update(NodeContext::now() - NodeContext::kUnderWay);
          context_.publishStatus(lock);
        });
      });
  const Lock lock(context_.mutex());
  context_.publishStatus(lock);
}

/// After a jump back: a capture takes only images that are stamped after its start.
void CalibrationNode::endCaptureOfOtherTime(const Lock& lock) {
  const double before = std::exchange(time_, NodeContext::now());
  if (time_ < before - NodeContext::kUnderWay)
    context_.calibration(lock).abandonCapture(std::string(NodeContext::kTimeJumpedBack) +
                                              "capture it again");
}

CalibrationNode::~CalibrationNode() {
  // The units are destroyed before the context: no image may reach them any more.
  context_.inputs().stop();
}

}  // namespace wiimote_tracker
