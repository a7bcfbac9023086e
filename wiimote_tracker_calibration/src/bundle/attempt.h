#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_ATTEMPT_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_ATTEMPT_H

#include "start.h"

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace wiimote_tracker::bundle {

/// A partial solution that started from one pair of cameras with one guess of their lenses.
struct Attempt {
  Reconstruction reconstruction;
  /// Mean squared error of the observations of the placed cameras, each limited for outliers.
  double cost = std::numeric_limits<double>::infinity();  ///< [px^2]
};

/// A lens with centred principal point, without distortion; focal length in image widths.
geometry::Intrinsics guessedLens(int width, int height, double focal_length);

/// Starts from a pair with the lenses in `observed`. The cost stays infinite if that fails.
Attempt attemptPair(const Reconstruction& observed, const CameraPair& pair, const Options& options);

/// Adds cameras, each with the focal length that fits best, until camera_count are placed.
/// @throws BundleError: a camera shares too few points with the others, or does not fit to them.
void grow(const SelfCalibrationOptions& options, std::size_t camera_count, Attempt* attempt);

/// Triangulates the points and adjusts them with the placed cameras; outliers are beyond
/// maximum_error [px].
void adjustPlaced(const Options& options, double maximum_error, Attempt* attempt);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_ATTEMPT_H
