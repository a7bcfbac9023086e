#pragma once

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <array>
#include <cstddef>
#include <limits>

namespace wiimote_tracker::bundle {

/// Prior of a lens that is not fixed: standard deviations, each > 0, and means.
struct ExpectedLens {
  double focal_length = std::numeric_limits<double>::infinity();  ///< Of log(f).
  double focal_about = 0.0;       ///< Its mean [image widths]; 0: the start value.
  double aspect = 0.002;          ///< Of log(fx / fy), mean 0.
  double principal_point = 0.05;  ///< Mean: the image's centre [image widths].
  /// Of k1, k2, p1, p2, k3, mean 0 [1]. k3 is practically fixed.
  std::array<double, 5> distortion = {0.5, 0.5, 0.002, 0.002, 1e-6};
};

struct Options {
  double maximum_error = 5.0;              ///< Of an inlier [px, > 0].
  double loss_scale = 1.0;                 ///< Of the Huber loss [px, > 0].
  std::size_t minimum_common_points = 10;  ///< Of a camera and the others [>= 8].
  double pixel_stddev = 1.0;               ///< Weight of observations against the lens [px, > 0].
  bool fixed_lenses = true;                ///< Intrinsics are given; solve() fixes them anyway.
  ExpectedLens lens;                       ///< Prior of lenses that are not fixed.
  bool one_lens = false;                   ///< All cameras have the first one's intrinsics.
  bool fixed_positions = false;            ///< Of all cameras.
  bool rough = false;                      ///< Start values: stop early, keep the inliers.
};

/// Estimates the poses of the cameras and the points with fixed lenses; poses, points and
/// inliers in `observed` are ignored, but not how many points there are. The result is determined
/// up to a similarity: the world is the frame of the first camera of the start pair, whose baseline
/// has length 1. Starts from two cameras with many common points in depth (essential matrix, Nister
/// 2004), adds the others one by one by resection, and calls adjust().
/// @throws BundleError: fewer than two cameras, an observation that is not finite or names no
/// camera or point, intrinsics out of range, a camera that shares too few points with the others or
/// only points on one line, a camera most of whose observations do not fit.
Reconstruction solve(Reconstruction observed, const Options& options);

/// Bundle adjustment: minimises the reprojection errors of the inliers (Huber loss) over cameras
/// and points except what is fixed, and selects the inliers again until they no longer change, at
/// most 20 times. Reconstruction::converged is false if they still change then, or if the last
/// minimisation stopped early. If no positions are fixed, the first camera keeps its pose.
/// @throws BundleError: no point is determined, or the minimisation fails.
void adjust(Reconstruction* reconstruction, const Options& options);

}  // namespace wiimote_tracker::bundle
