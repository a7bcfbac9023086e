#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_ATTEMPT_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_ATTEMPT_H

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace wiimote_tracker::bundle {

/// A solution in the making, from one pair of cameras with one guess of their lenses.
struct Attempt {
  Reconstruction reconstruction;
  std::vector<bool> placed;  ///< Per camera.
  /// Mean squared error of what the placed cameras saw, each cut off where it is surely wrong.
  double cost = std::numeric_limits<double>::infinity();  ///< [px^2]
};

/// Pairs of cameras to start from, the most promising first: many common points, and views that
/// differ by more than one plane explains. At most `count`.
std::vector<std::pair<std::size_t, std::size_t>> likelyPairs(const Reconstruction& observed,
                                                             const Options& options,
                                                             std::size_t count);

/// A centred lens of this focal length [image widths] and this distortion.
geometry::Intrinsics guessedLens(int width, int height, double focal_length, double k1);

/// Starts from a pair with the lenses as they are in `observed`. The cost stays infinite when that
/// leads nowhere.
Attempt attemptPair(const Reconstruction& observed,
                    const std::pair<std::size_t, std::size_t>& pair,
                    const Options& options);

/// Places further cameras, each with the lens that suits it best, until camera_count are placed.
/// @throws BundleError: a camera shares too few points with the others, or does not fit to them.
void grow(const SelfCalibrationOptions& options, std::size_t camera_count, Attempt* attempt);

/// Lets points and placed cameras settle, wrong observations being told apart at maximum_error
/// [px].
void settle(const Options& options, double maximum_error, Attempt* attempt);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_ATTEMPT_H
