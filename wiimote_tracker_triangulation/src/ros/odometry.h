#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_ODOMETRY_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_ODOMETRY_H

#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

namespace wiimote_tracker {

/// Pose in the world frame; child frame and twist: the body's. The covariance of the twist includes
/// that of the orientation, taken as independent of the velocities.
nav_msgs::Odometry odometry(const wiimote_tracker_msgs::TrackedBodyArray& array,
                            const wiimote_tracker_msgs::TrackedBody& body);

/// The twist alone, in its frame.
geometry_msgs::TwistWithCovarianceStamped twistOf(const nav_msgs::Odometry& odometry);

/// Of one LED; its frame has the world's axes. What is unknown is 0 with the variance
/// kUnknownVariance: orientation, angular velocity, and with mode instant the velocity.
nav_msgs::Odometry odometry(const wiimote_tracker_msgs::TrackedPointArray& array,
                            const wiimote_tracker_msgs::TrackedPoint& point);

/// [rad^2], [rad^2/s^2], [m^2/s^2]
constexpr double kUnknownVariance = 1e6;

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_ODOMETRY_H
