#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_START_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_START_H

#include "wiimote_tracker_calibration/bundle/solve.h"

#include <cstddef>
#include <map>
#include <vector>

namespace wiimote_tracker::bundle {

/// Rays of what each camera saw, on its normalised image plane (x/z, y/z), by point. Pixels
/// without a ray are left out.
using NormalizedViews = std::vector<std::map<std::size_t, Eigen::Vector2d>>;

NormalizedViews normalize(const Reconstruction& reconstruction);

/// Poses the pair of cameras with the most parallax (essential matrix) and computes their points.
/// The first of the pair becomes the world's frame, their distance 1. Marks both in placed.
/// @throws BundleError when no pair has enough points in common.
void startFromPair(const NormalizedViews& views,
                   const Options& options,
                   Reconstruction* reconstruction,
                   std::vector<bool>* placed);

/// Poses the camera that sees most of the known points (resection), and marks it in placed.
/// @throws BundleError when every remaining camera sees too few of them.
void placeNext(const NormalizedViews& views,
               const Options& options,
               Reconstruction* reconstruction,
               std::vector<bool>* placed);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_START_H
