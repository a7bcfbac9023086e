#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLANAR_POSE_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLANAR_POSE_H

#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"

#include <Eigen/Geometry>

#include <vector>

namespace wiimote_tracker::square {

/// Poses (world_from_camera, best first) from which the four corners look as they were seen. A
/// plane has up to two: the second is, nearly, its mirror image at the line of sight (Collins and
/// Bartoli, Infinitesimal Plane-Based Pose Estimation, 2014). Approximate: refine them.
/// Lens distortion is taken out first. All corners must have been seen and have the same z.
/// Empty when there is none.
std::vector<Eigen::Isometry3d> planarPoses(const CameraSightings& sightings,
                                           const Corners& corners);

/// Whether two poses are the same to within 0.02 degrees and 0.02 % of the distance to the square.
bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Corners& corners);

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLANAR_POSE_H
