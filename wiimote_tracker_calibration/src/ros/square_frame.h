#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_SQUARE_FRAME_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_SQUARE_FRAME_H

#include "workflow/calibration.h"

#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/TransformStamped.h>

#include <vector>

namespace wiimote_tracker {

/// Where the parameters put the calibration square: the frame <world frame>_square has its origin
/// at the first corner, x towards the second, and y towards the fourth.
geometry_msgs::TransformStamped squareTransform(const workflow::CalibrationOptions& options);

/// The corners in that frame, in the order of capture. @param sides along x, along y [m]; empty: no
/// corners.
geometry_msgs::PolygonStamped squareOutline(const workflow::CalibrationOptions& options,
                                            const std::vector<double>& sides);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_SQUARE_FRAME_H
