#pragma once

#include "wiimote_tracker_calibration/square/square_layout.h"

#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <optional>
#include <string>

namespace wiimote_tracker {

/// The square that a rig was calibrated with. Nothing: none, or it is not known where it lies.
std::optional<square::SquareLayout> squareOf(const geometry::Rig& rig);

/// Where a square lies: the frame <world frame>_square has its origin at the first corner, x
/// towards the second, and y towards the fourth.
geometry_msgs::TransformStamped squareTransform(const std::string& world_frame,
                                                const square::SquareLayout& square);

/// The corners on the floor, in the order of capture, in the world. No square: no corners.
geometry_msgs::PolygonStamped squareOutline(const std::string& world_frame,
                                            const std::optional<square::SquareLayout>& square);

}  // namespace wiimote_tracker
