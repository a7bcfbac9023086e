#pragma once

#include "identity/led_labels.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <nav_msgs/Odometry.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

namespace wiimote_tracker {

/// The message of a snapshot with all of its LEDs, without method, rig_id and late_frames, which
/// the snapshot does not tell.
wiimote_tracker_msgs::TrackedPointArray pointMessage(const tracking::Snapshot& snapshot,
                                                     const geometry::Rig& rig,
                                                     const identity::LedLabels& labels);

/// @param time of the LED's snapshot [s].
wiimote_tracker_msgs::TrackedPoint trackedPoint(const tracking::TrackedLed& led,
                                                double time,
                                                const geometry::Rig& rig,
                                                const identity::LedLabels& labels);

/// Of one LED; its frame has the world's axes. What is unknown is 0 with the variance
/// kUnknownVariance: orientation, angular velocity, and with mode instant the velocity.
nav_msgs::Odometry odometry(const wiimote_tracker_msgs::TrackedPointArray& array,
                            const wiimote_tracker_msgs::TrackedPoint& point);

/// [rad^2], [rad^2/s^2], [m^2/s^2]
constexpr double kUnknownVariance = 1e6;

}  // namespace wiimote_tracker
