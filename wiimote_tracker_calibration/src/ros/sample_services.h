#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_SAMPLE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_SAMPLE_SERVICES_H

#include "node_context.h"

#include <wiimote_tracker_msgs/LoadSamples.h>
#include <wiimote_tracker_msgs/SaveSamples.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The file of what was captured: save_samples, load_samples.
class SampleServices {
 public:
  explicit SampleServices(NodeContext* context);

 private:
  bool save(wiimote_tracker_msgs::SaveSamples::Request& request,
            wiimote_tracker_msgs::SaveSamples::Response& response);
  bool load(wiimote_tracker_msgs::LoadSamples::Request& request,
            wiimote_tracker_msgs::LoadSamples::Response& response);
  std::string pathOr(const std::string& path);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_SAMPLE_SERVICES_H
