#pragma once

#include "wiimote_tracker_calibration/import/recording.h"

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::import {

/// A solution for comparison: cameras and points.
struct Reference {
  geometry::Rig rig;  ///< Same cameras and pixels as Solution::rig.
  std::vector<std::optional<Eigen::Vector3d>> points;  ///< One per frame [m].
};

/// A recording with a rig that a tracker can use.
struct Solution {
  geometry::Rig rig;
  std::vector<Pixels> frames;  ///< As seen by the rig's cameras.
  std::optional<Reference> reference;
};

/// If projection matrices are shipped, they are the rig. Such a camera is a pinhole with skew, for
/// undistorted pixels; the pixels are converted to a pinhole without skew whose image contains them
/// all. The reference has the shipped points.
///
/// If only intrinsics are shipped, the poses are solved from the pixels (bundle::solve). The
/// reference keeps the shipped camera centres, with the orientations that fit best.
///
/// The world is the frame of the shipped camera centres; without those it is that of the solver or
/// of the matrices, with an arbitrary scale.
/// @throws ImportError: the observations do not determine the cameras, or shipped data are
/// impossible.
Solution solve(const Recording& recording);

}  // namespace wiimote_tracker::import
