#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_FILE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_FILE_SERVICES_H

#include "node_context.h"
#include "session/join_rigs.h"

#include <wiimote_tracker_msgs/JoinRig.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/LoadSamples.h>
#include <wiimote_tracker_msgs/SaveRig.h>
#include <wiimote_tracker_msgs/SaveSamples.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Files: save and load (the rig), save_samples and load_samples (what was captured), and join (the
/// rig with another room's).
class FileServices {
 public:
  /// Loads and publishes the last saved rig, if there is one.
  explicit FileServices(NodeContext* context);

 private:
  workflow::Reply save(const wiimote_tracker_msgs::SaveRig::Request& request,
                       wiimote_tracker_msgs::SaveRig::Response* response);
  workflow::Reply load(const wiimote_tracker_msgs::LoadRig::Request& request,
                       wiimote_tracker_msgs::LoadRig::Response* response);
  workflow::Reply saveSamples(const wiimote_tracker_msgs::SaveSamples::Request& request,
                              wiimote_tracker_msgs::SaveSamples::Response* response);
  workflow::Reply loadSamples(const wiimote_tracker_msgs::LoadSamples::Request& request,
                              wiimote_tracker_msgs::LoadSamples::Response* response);
  workflow::Reply join(const wiimote_tracker_msgs::JoinRig::Request& request,
                       wiimote_tracker_msgs::JoinRig::Response* response);

  workflow::Reply loadRig(const std::string& path);
  /// The known places that were measured with this rig.
  std::vector<session::CommonPlace> commonPlaces(const std::string& rig_id, const Lock& lock);

  NodeContext& context_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_FILE_SERVICES_H
