#pragma once

#include "wiimote_tracker_calibration/bundle/reconstruction.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::bundle {

struct SelfCalibrationOptions {
  Options bundle = [] {
    Options options;
    options.fixed_lenses = false;
    options.lens.focal_length = 0.7;  // weak: a field of view of 20 to 71 degrees
    options.lens.focal_about = 1.4;
    return options;
  }();
  /// Focal lengths to start from [image widths]: fields of view from 90 to 14 degrees.
  std::vector<double> focal_lengths = {0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0};
};

/// How well the lens of one camera is known.
struct LensCertainty {
  double focal_stddev = 0.0;  ///< Of fx [px]; infinite if the covariance is singular.
  bool focal_determined = false;
};

struct SelfCalibration {
  Reconstruction reconstruction;
  double pixel_stddev = 0.0;          ///< Of one coordinate, estimated from the residuals [px].
  std::vector<LensCertainty> lenses;  ///< In the order of the cameras.
  /// Expected RMS error of the points after the best similarity [unit of the points]; nothing if
  /// the covariance is singular.
  std::optional<double> expected_shape_error;
  std::size_t starts = 0;    ///< Combinations of camera pair and focal length tried.
  std::size_t followed = 0;  ///< The best of these, adjusted with all cameras.
  std::size_t agreeing = 0;  ///< Of these, those that reached the solution returned.
};

/// Called during the work with the present step and the progress, 0 to 1.
using ProgressCallback = std::function<void(const std::string& step, double fraction)>;

/// Estimates cameras, lenses and points from the observations alone. Of the cameras in `observed`
/// it uses names and image sizes, and the intrinsics if these are given; of the points their
/// number. The result is determined up to a similarity, as that of solve(), and up to a reflection.
///
/// With given intrinsics: solve(). Otherwise it tries many starts with some of the points: pairs of
/// cameras whose views no plane explains, with each focal length (essential matrix);
/// other cameras are added by resection, each with its own best focal length. The best starts are
/// adjusted with all cameras, the best of these with all points: focal lengths, principal point,
/// k1, k2, p1, p2 of each camera, with the prior Options::lens. A focal length counts as determined
/// if its standard deviation without that prior is small and no other solution fits as well.
///
/// @throws BundleError as solve(), and: one camera's image is mirrored; the given intrinsics of two
/// cameras are exchanged; the light moved on a line or in a plane only, or all cameras stand in one
/// place; no solution fits.
SelfCalibration selfCalibrate(Reconstruction observed,
                              const SelfCalibrationOptions& options,
                              const ProgressCallback& progress = nullptr);

}  // namespace wiimote_tracker::bundle
