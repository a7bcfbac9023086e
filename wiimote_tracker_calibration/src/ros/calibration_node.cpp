#include "calibration_node.h"

#include <string>
#include <utility>

namespace wiimote_tracker {

CalibrationNode::CalibrationNode(const ros::NodeHandle& nh, const Parameters& parameters)
    : context_(nh, parameters),
      parts_({fileServices(&context_), captureServices(&context_), maskServices(&context_),
              solveServices(&context_), boardServices(&context_), placeServices(&context_),
              recalibrateServices(&context_), continuousServices(&context_, &one_led_inputs_),
              healthMonitor(&context_, &one_led_inputs_)}) {
  context_.inputs().start();
  status_timer_ = context_.everyHalfSecond("the status", [this] {
    const Lock lock(context_.mutex());
    endRecordingOfOtherTime(lock);
    context_.calibration(lock).update(NodeContext::now() - NodeContext::kUnderWay);
    context_.publishStatus(lock);
  });
  const Lock lock(context_.mutex());
  context_.publishStatus(lock);
}

/// A capture or wave takes only images that are stamped after its start.
void CalibrationNode::endRecordingOfOtherTime(const Lock& lock) {
  const double before = std::exchange(time_, NodeContext::now());
  if (time_ >= before - NodeContext::kUnderWay)
    return;
  const std::string why = NodeContext::kTimeJumpedBack;
  context_.calibration(lock).abandonCapture(why + "capture it again");
  context_.calibration(lock).abandonWave(why + "record it again, unless it was enough");
}

CalibrationNode::~CalibrationNode() {
  context_.stop();
}

}  // namespace wiimote_tracker
