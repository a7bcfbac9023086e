#pragma once

#include "bundle_problem.h"
#include "start.h"
#include "wiimote_tracker_calibration/bundle/self_calibrate.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>

/// The steps of selfCalibrate(), of which solve() uses some.
namespace wiimote_tracker::bundle {

/// @throws BundleError: invalid observations, fewer than two cameras.
void checkObservations(const Reconstruction& reconstruction);

/// @throws BundleError if most observations of some camera are outliers.
void refuseUnexplained(const Reconstruction& reconstruction, const Options& options);

/// Whether the observations of each camera lie on a line in its image.
bool isOnALine(const Reconstruction& reconstruction);

/// Whether the solution's depth is not determined, since the light moved in a plane or all cameras
/// stand in one place: a homography explains the views of any two cameras to 3 times the solution's
/// error, or to `slack` [image widths].
bool isFlat(const Reconstruction& solution, const Options& options, double slack);

/// Looks for the cause if no solution fits: one camera's image is mirrored, or the given intrinsics
/// of two cameras are exchanged. @param works whether a solution fits the changed observations.
/// @returns a sentence, or nothing if neither helps.
std::optional<std::string> suspicion(const Reconstruction& observed,
                                     bool intrinsics_given,
                                     const std::function<bool(const Reconstruction&)>& works);

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

/// Standard deviation of one pixel coordinate, estimated from the residuals of the inliers [px].
double pixelStddev(const Reconstruction& reconstruction, const Options& options);

/// Covariance of an adjusted reconstruction, to first order: the inverse of the information of the
/// inliers, with pixelStddev(). The adjustment's Huber loss hardly changes it
/// (test_self_calibrate.cpp). Options::lens counts too, but not its focal length.
class Certainty {
 public:
  Certainty(const Reconstruction& reconstruction, const Options& options);

  /// Covariance of a lens in the order fx, fy, cx, cy, k1, k2, p1, p2, k3. Nothing when the
  /// observations leave some parameter open.
  std::optional<Eigen::MatrixXd> lensCovariance(std::size_t camera) const;

  /// How far a lens is from the optimum of these observations, to first order, in the same order;
  /// lensCovariance() must be known.
  Eigen::VectorXd lensStep(std::size_t camera) const;

  /// Expected RMS distance of the points from the truth after the best similarity [unit of the
  /// points], from the errors of cameras, lenses and pixels together; of a sample of the points.
  /// Nothing when some parameter is open.
  std::optional<double> expectedShapeError();

 private:
  /// Of its first parameter in `lenses_`.
  Eigen::Index columnOf(std::size_t camera) const;

  const bool one_lens_;
  const double pixel_stddev_;
  Reconstruction reconstruction_;
  BundleProblem problem_;
  std::optional<adjust::Estimate> lenses_;  // for residuals of 1 px
};

/// How many times farther than their covariance says the lenses move when a part of the
/// observations decides: halves of the points in time and in space, and all cameras but one.
/// Residuals that are not independent, and lens terms that are not modelled, make it larger than 1
/// (Birge 1932). At least 1; 1 too when the parts do not determine the lenses.
double birgeRatio(const Reconstruction& adjusted, const Options& options);

}  // namespace wiimote_tracker::bundle
