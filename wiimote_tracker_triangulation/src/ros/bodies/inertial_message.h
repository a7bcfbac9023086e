#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_INERTIAL_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_INERTIAL_MESSAGE_H

#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/inertial_samples.h"

#include <sensor_msgs/Imu.h>

#include <optional>

namespace wiimote_tracker {

/// Along the body's axes, by the clock of the images. Nothing if the message says that it has no
/// angular velocity or acceleration (REP 145: a covariance that begins with -1), or if a number is
/// not finite.
std::optional<body::InertialSample> inertialSample(const sensor_msgs::Imu& message,
                                                   const body::ImuMount& mount);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_INERTIAL_MESSAGE_H
