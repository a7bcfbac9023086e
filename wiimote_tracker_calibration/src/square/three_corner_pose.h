#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_THREE_CORNER_POSE_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_THREE_CORNER_POSE_H

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace wiimote_tracker::square {

/// Poses (world_from_camera) from which three points are seen in three directions: up to four, and
/// nothing in them tells which (Grunert 1841; Haralick et al., Review and Analysis of Solutions of
/// the Three Point Perspective Pose Estimation Problem, 1994). Where errors of the directions leave
/// no exact pose, the nearest ones, as starts.
/// @param points not on a line, world [m].
/// @param directions in the optical frame, of any length.
std::vector<Eigen::Isometry3d> threeCornerPoses(const std::array<Eigen::Vector3d, 3>& points,
                                                const std::array<Eigen::Vector3d, 3>& directions);

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_THREE_CORNER_POSE_H
