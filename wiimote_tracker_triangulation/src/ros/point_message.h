#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_POINT_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_POINT_MESSAGE_H

#include "led_labels.h"
#include "volume_correction.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <cstdint>
#include <string>

namespace wiimote_tracker {

/// Fields of the message that are not in the snapshot.
struct PointContext {
  std::string method;             ///< How the points were computed.
  std::string rig_id;             ///< Id of the rig, as published.
  std::uint64_t late_frames = 0;  ///< As in TrackedPointArray.msg.
};

/// The message of a snapshot with all of its LEDs.
wiimote_tracker_msgs::TrackedPointArray pointMessage(const CorrectedSnapshot& corrected,
                                                     const geometry::Rig& rig,
                                                     const LedLabels& labels,
                                                     const PointContext& context);

/// The LED at `index` in the snapshot.
wiimote_tracker_msgs::TrackedPoint trackedPoint(const CorrectedSnapshot& corrected,
                                                std::size_t index,
                                                const geometry::Rig& rig,
                                                const LedLabels& labels);

geometry_msgs::PointStamped pointStamped(const wiimote_tracker_msgs::TrackedPointArray& array,
                                         const wiimote_tracker_msgs::TrackedPoint& point);

/// World frame -> label, without rotation.
geometry_msgs::TransformStamped transform(const wiimote_tracker_msgs::TrackedPointArray& array,
                                          const wiimote_tracker_msgs::TrackedPoint& point);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_POINT_MESSAGE_H
