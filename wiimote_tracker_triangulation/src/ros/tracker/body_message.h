#pragma once

#include "body/body_tracker.h"
#include "body/constellation.h"
#include "body/inertial_samples.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// The message of a snapshot with all of its bodies.
wiimote_tracker_msgs::TrackedBodyArray bodyMessage(
    const body::BodySnapshot& snapshot,
    const std::vector<body::Constellation>& constellations,
    const geometry::Rig& rig,
    const std::string& rig_id);

/// Pose in the world frame; child frame and twist: the body's. The covariance of the twist includes
/// that of the orientation, taken as independent of the velocities.
nav_msgs::Odometry odometry(const wiimote_tracker_msgs::TrackedBodyArray& array,
                            const wiimote_tracker_msgs::TrackedBody& body);

/// Along the body's axes, by the clock of the images. Nothing if the message says that it has no
/// angular velocity or acceleration (REP 145: a covariance that begins with -1), or if a number is
/// not finite.
std::optional<body::InertialSample> inertialSample(const sensor_msgs::Imu& message,
                                                   const body::ImuMount& mount);

}  // namespace wiimote_tracker
