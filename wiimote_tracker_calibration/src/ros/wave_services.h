#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H

#include "node_context.h"

#include <wiimote_tracker_msgs/StartWave.h>

#include <vector>

namespace wiimote_tracker {

/// The wave: start_wave, stop_wave.
class WaveServices {
 public:
  explicit WaveServices(NodeContext* context);

 private:
  workflow::Reply start(const wiimote_tracker_msgs::StartWave::Request& request,
                        wiimote_tracker_msgs::StartWave::Response* response);
  workflow::Reply stop();

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H
