#include "units.h"

#include <wiimote_tracker_msgs/MeasureLength.h>

namespace wiimote_tracker {

using wiimote_tracker_msgs::MeasureLength;

namespace {

class MeasureServices {
 public:
  explicit MeasureServices(NodeContext* context)
      : context_(*context),
        length_(advertise(context_.nh(),
                          "calibration/measure_length",
                          &MeasureServices::measureLength,
                          this)) {}

 private:
  workflow::Reply measureLength(const MeasureLength::Request& request, MeasureLength::Response*) {
    square::TapedLength taped;
    taped.from = request.from_corner;
    taped.to = request.to_corner;
    taped.length = request.length;
    if (request.stddev != 0.0)
      taped.stddev = request.stddev;
    const Lock lock(context_.mutex());
    const workflow::Reply reply = context_.calibration(lock).measureLength(
        taped, context_.parameters(lock).solve.square.uncertainty.placement);
    context_.publishStatus(lock);
    return reply;
  }

  NodeContext& context_;
  ros::ServiceServer length_;
};

}  // namespace

Unit measureServices(NodeContext* context) {
  return std::make_shared<MeasureServices>(context);
}

}  // namespace wiimote_tracker
