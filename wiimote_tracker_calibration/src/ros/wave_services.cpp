#include "units.h"

#include "begin_wave.h"

#include <wiimote_tracker_msgs/StartWave.h>

#include <vector>

namespace wiimote_tracker {

namespace {

class WaveServices {
 public:
  explicit WaveServices(NodeContext* context)
      : context_(*context),
        services_({advertise(context, "calibration/start_wave", &WaveServices::start, this),
                   advertise(context, "calibration/stop_wave", &WaveServices::stop, this)}) {}

 private:
  workflow::Reply start(const wiimote_tracker_msgs::StartWave::Request& request,
                        wiimote_tracker_msgs::StartWave::Response*,
                        Lock& lock) {
    return beginWave(wandOf(request.wand_length, request.wand_stddev), &context_, &lock);
  }

  workflow::Reply stop(Lock& lock) { return context_.calibration(lock).endWave(); }

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace

Unit waveServices(NodeContext* context) {
  return std::make_shared<WaveServices>(context);
}

}  // namespace wiimote_tracker
