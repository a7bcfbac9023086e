#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_MESSAGE_H

#include "body/body_follower.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The message of a snapshot with all of its bodies.
wiimote_tracker_msgs::TrackedBodyArray bodyMessage(
    const body::BodySnapshot& snapshot,
    const std::vector<body::Constellation>& constellations,
    const geometry::Rig& rig,
    const std::string& rig_id);

geometry_msgs::PoseWithCovarianceStamped poseStamped(
    const wiimote_tracker_msgs::TrackedBodyArray& array,
    const wiimote_tracker_msgs::TrackedBody& body);

/// World frame -> body.
geometry_msgs::TransformStamped transform(const wiimote_tracker_msgs::TrackedBodyArray& array,
                                          const wiimote_tracker_msgs::TrackedBody& body);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_MESSAGE_H
