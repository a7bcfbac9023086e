#ifndef WIIMOTE_TRACKER_BRINGUP_IMPORT_PINHOLE_H
#define WIIMOTE_TRACKER_BRINGUP_IMPORT_PINHOLE_H

#include "recording.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::import {

/// A projection matrix taken apart: P = scale * K [R | -R center], K upper triangular with positive
/// diagonal and K(2, 2) = 1, R a rotation.
struct Pinhole {
  double fx;    ///< [px]
  double fy;    ///< [px]
  double cx;    ///< [px]
  double cy;    ///< [px]
  double skew;  ///< K(0, 1) [px]
  Eigen::Isometry3d world_from_camera;
};

/// @throws ImportError naming `name` when the left 3x3 part is singular.
Pinhole takeApart(const ProjectionMatrix& projection, const std::string& name);

/// The camera of a shipped projection matrix as a pinhole without distortion and skew, and its
/// pixels in all frames (entry `index` of each) changed to match. The image grows to the smallest
/// one, by whole pixels, that holds the old image and all pixels; a pixel that has no ray becomes
/// unseen.
/// @param mirrored the matrix is for a mirror image of the world; z is then turned round.
geometry::Camera rectify(const RecordedCamera& recorded,
                         bool mirrored,
                         std::size_t index,
                         std::vector<Pixels>* frames);

}  // namespace wiimote_tracker::import

#endif  // WIIMOTE_TRACKER_BRINGUP_IMPORT_PINHOLE_H
