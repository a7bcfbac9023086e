#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H

#include "node_context.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/StartWave.h>

#include <vector>

namespace wiimote_tracker {

/// The wave: start_wave, stop_wave.
class WaveServices {
 public:
  explicit WaveServices(NodeContext* context);

 private:
  bool start(wiimote_tracker_msgs::StartWave::Request& request,
             wiimote_tracker_msgs::StartWave::Response& response);
  bool stop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H
