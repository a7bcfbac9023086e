#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENT_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENT_MESSAGE_H

#include "measurements/writer.h"

#include <wiimote_tracker_msgs/TrackedPointArray.h>

namespace wiimote_tracker {

/// Writes each LED of a message. @param triggered whether the message answers a trigger.
/// @throws Error.
void writeMeasurements(const wiimote_tracker_msgs::TrackedPointArray& points,
                       bool triggered,
                       measurements::Writer* writer);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENT_MESSAGE_H
