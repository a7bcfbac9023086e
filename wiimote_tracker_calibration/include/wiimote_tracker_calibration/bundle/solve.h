#ifndef WIIMOTE_TRACKER_CALIBRATION_BUNDLE_SOLVE_H
#define WIIMOTE_TRACKER_CALIBRATION_BUNDLE_SOLVE_H

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace wiimote_tracker::bundle {

/// What is known of a lens before it is estimated: standard deviations, each > 0.
struct LensPrior {
  double focal_length = std::numeric_limits<double>::infinity();  ///< Of log(f).
  double focal_about = 0.0;       ///< [image widths]; 0: about what it starts with.
  double aspect = 0.01;           ///< Of log(fx / fy), about 0.
  double principal_point = 0.05;  ///< About the image's centre [image widths].
  /// k1, k2, p1, p2, k3, about 0 [1]. k3 is as good as held.
  std::array<double, 5> distortion = {0.5, 0.5, 0.005, 0.005, 1e-6};
};

struct Options {
  double maximum_error = 5.0;              ///< An observation farther off is an outlier [px, > 0].
  double loss_scale = 1.0;                 ///< Errors beyond this weigh linearly (Huber) [px, > 0].
  double minimum_angle = 0.02;             ///< Between the rays of a point [rad].
  std::size_t minimum_common_points = 10;  ///< That tie a camera to the others [>= 8].
  double pixel_stddev = 1.0;               ///< Weighs observations against LensPrior [px, > 0].
  LensPrior lens;                          ///< Of cameras whose intrinsics are not held.
  bool one_lens = false;                   ///< All cameras share the first one's intrinsics.
  bool rough = false;                      ///< A start only: stop early, keep the inliers.
};

/// What an adjustment must not move.
struct Held {
  bool rotations = false;  ///< Of all cameras.
  bool positions = false;  ///< Of all cameras.
  bool intrinsics = true;  ///< Of all cameras; else Options::lens says what is known of them.
  bool points = false;
};

/// Poses of the cameras and the points from the observations alone; the intrinsics are given, the
/// poses in `cameras` are ignored. The result is known up to a similarity: the world is the frame
/// of the camera that it was started from, and the length of one baseline is 1.
/// Start: the pair of cameras with the most parallax over common points (essential matrix, Nister
/// 2004), then the others one by one by resection; then adjust().
/// @param point_count observations name points 0 .. point_count - 1.
/// @throws BundleError: fewer than two cameras, an observation that is not finite or names no
/// camera or point, intrinsics out of range, a camera that shares too few points with the others or
/// only points on one line, a camera most of whose observations do not fit.
Reconstruction solve(const std::vector<geometry::Camera>& cameras,
                     const std::vector<Observation>& observations,
                     std::size_t point_count,
                     const Options& options);

/// Moves cameras (except what is held) and points to the least sum of squared reprojection errors
/// of the inliers (Huber loss), and chooses the inliers anew until they no longer change.
/// Where all rotations and positions are free, one camera is kept in its place.
/// @throws BundleError: no point is determined, or the minimisation fails.
void adjust(Reconstruction* reconstruction, const Options& options, const Held& held);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_BUNDLE_SOLVE_H
