#ifndef WIIMOTE_TRACKER_BRINGUP_IMPORT_SOLUTION_H
#define WIIMOTE_TRACKER_BRINGUP_IMPORT_SOLUTION_H

#include "wiimote_tracker_calibration/import/recording.h"

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::import {

/// A solution to compare with: cameras, and where they say the light was.
struct Reference {
  geometry::Rig rig;  ///< Same cameras and pixels as Solution::rig.
  std::vector<std::optional<Eigen::Vector3d>> points;  ///< One per frame [m].
};

/// A recording with cameras that a tracker can work with.
struct Solution {
  geometry::Rig rig;
  std::vector<Pixels> frames;  ///< As the rig's cameras see them.
  std::optional<Reference> reference;
};

/// Projection matrices shipped: the rig is the shipped one. Such a camera is a pinhole with skew
/// after the distortion was taken away; the pixels are turned into those of a pinhole without
/// either, on an image grown so that all of them lie in it. The reference is the shipped points.
///
/// Intrinsics only: the poses are solved from the pixels (bundle::solve), which stay as they are.
/// The reference holds the shipped camera centres fixed, with the orientations that fit best.
///
/// Either way the world is the frame of the shipped camera centres; without those it is the
/// solver's or the matrices' own, with a scale that means nothing.
/// @throws ImportError: the observations do not determine the cameras, or something shipped with
/// them is impossible.
Solution solve(const Recording& recording);

}  // namespace wiimote_tracker::import

#endif  // WIIMOTE_TRACKER_BRINGUP_IMPORT_SOLUTION_H
