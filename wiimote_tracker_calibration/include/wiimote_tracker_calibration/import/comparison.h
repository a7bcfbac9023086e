#pragma once

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::import {

/// A solution compared with the calibration that was shipped with the recording.
struct Comparison {
  std::string what;                         ///< What was shipped, and the errors' pixels.
  std::vector<bundle::Statistics> own;      ///< Per camera.
  std::vector<bundle::Statistics> shipped;  ///< Same pixels, same limit for inliers.
  std::size_t points = 0;                   ///< That both solutions have.
  double extent = 0.0;                      ///< RMS distance of these from their mean, as shipped.
  /// Distances between own and shipped points, after the best similarity and after the best
  /// projective transformation [the shipped unit].
  bundle::Statistics similar;
  bundle::Statistics projective;
  /// Expected RMS distance after a similarity from the solution's own covariance; nothing if
  /// singular.
  std::optional<double> expected;
};

/// Nothing when no intrinsics were shipped, without which nothing is known of the distortion.
///
/// If matrices and intrinsics agree, errors are in recorded pixels. Other matrices: errors of both
/// are in the undistorted pixels of the matrices. Intrinsics only: the shipped solution is that of
/// bundle::solve() with them; errors are in recorded pixels.
/// An observation is an inlier within options.maximum_error of the point of that solution.
/// @throws ImportError: the matrices do not fit to the pixels.
std::optional<Comparison> compare(const Recording& recording,
                                  const bundle::SelfCalibration& solution,
                                  const bundle::Options& options);

}  // namespace wiimote_tracker::import
