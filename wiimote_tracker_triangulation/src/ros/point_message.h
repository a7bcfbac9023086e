#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_POINT_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_POINT_MESSAGE_H

#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <string>

namespace wiimote_tracker {

/// What the message says besides the instant itself.
struct PointContext {
  std::string label;       ///< Of the LED.
  std::string method;      ///< Word of the triangulation method.
  std::string rig_id;      ///< Id of the rig, as published.
  double first_seen = 0.;  ///< When the LED was first seen [s]; only used with a point.
  bool remapped = false;   ///< The point was corrected and lies in the corrected volume.
};

/// The message of one instant: one point, or none. `time` of the core becomes ros::Time.
wiimote_tracker_msgs::TrackedPointArray pointMessage(const fusion::Instant& instant,
                                                     const geometry::Rig& rig,
                                                     std::uint64_t late_frames,
                                                     const PointContext& context);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_POINT_MESSAGE_H
