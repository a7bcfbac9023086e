#ifndef WIIMOTE_TRACKER_CALIBRATION_BUNDLE_SELF_CALIBRATE_H
#define WIIMOTE_TRACKER_CALIBRATION_BUNDLE_SELF_CALIBRATE_H

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
    options.lens.focal_length = 0.7;  // weak: a field of view of 20 to 65 degrees
    options.lens.focal_about = 1.4;
    return options;
  }();
  bool fixed_lenses = false;  ///< The intrinsics of the cameras are given.
  /// Focal lengths to start from [image widths]: fields of view from 90 to 14 degrees.
  std::vector<double> focal_lengths = {0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0};
  /// Distortions k1 to start from [1].
  std::vector<double> distortions = {0.0, -0.25};
  /// A focal length less certain than this is called not determined [1].
  double maximum_focal_uncertainty = 0.05;
};

/// How well one camera's lens is known from the observations.
struct LensCertainty {
  double focal_stddev = 0.0;            ///< Of fx [px]; infinite when it is not determined at all.
  double principal_point_stddev = 0.0;  ///< The larger of both axes [px].
  bool focal_determined = false;
};

struct SelfCalibration {
  Reconstruction reconstruction;
  double pixel_stddev = 0.0;          ///< Of one coordinate, as the residuals show it [px].
  std::vector<LensCertainty> lenses;  ///< In the order of the cameras.
  /// RMS of what the points of a repetition would differ by after the best similarity [unit of the
  /// points]; nothing when the observations leave it open.
  std::optional<double> expected_shape_error;
  std::size_t starts = 0;    ///< Tried: pairs of cameras, focal lengths, distortions.
  std::size_t followed = 0;  ///< Of these, adjusted to the end: the most promising.
  std::size_t agreeing = 0;  ///< Of these, ended in the solution that was taken.
};

/// Called now and then with what is being done and how far it is, 0 to 1. @returns false to stop.
using ProgressCallback = std::function<bool(const std::string& step, double fraction)>;

/// Cameras, lenses and points from the observations alone. Of `cameras` names and image sizes
/// count, and the intrinsics when these are given. The result is known up to a similarity, as that
/// of solve(); no observation tells a recording from one in which all images are mirrored.
///
/// With given intrinsics: solve(). Otherwise many starts are tried on a part of the points: pairs
/// of cameras whose views differ by more than a plane explains, with each focal length and
/// distortion (essential matrix); further cameras join by resection, each with its own best focal
/// length. The most promising are adjusted to the end, the best of these with all points: focal
/// lengths, aspect, principal point, k1, k2, p1, p2 of each camera, helped by what Options::lens
/// says is known of them. A focal length is determined when the observations alone tell it, and
/// when no other solution explains them as well.
///
/// @throws BundleError as solve() does, and: one camera's image is mirrored; two cameras' given
/// intrinsics are exchanged; the light moved on a line or in a plane only, or the cameras stand in
/// one place; nothing explains the observations; stopped by the callback.
SelfCalibration selfCalibrate(const std::vector<geometry::Camera>& cameras,
                              const std::vector<Observation>& observations,
                              std::size_t point_count,
                              const SelfCalibrationOptions& options,
                              const ProgressCallback& progress = nullptr);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_BUNDLE_SELF_CALIBRATE_H
