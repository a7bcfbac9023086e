#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETERS_H

#include "marker_builder.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"

#include <ros/node_handle.h>

#include <string>

namespace wiimote_tracker {

/// Parameters of the node; meaning and ranges: config/triangulation.yaml.
struct TriangulationParameters {
  std::string label = "led";
  fusion::InstantFuserOptions fuser;
  MarkerOptions markers;

  /// @throws ParameterError naming the key that is wrong or unknown.
  static TriangulationParameters read(const ros::NodeHandle& nh);
};

/// The word for a method in parameters and messages.
std::string methodName(geometry::TriangulationMethod method);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETERS_H
