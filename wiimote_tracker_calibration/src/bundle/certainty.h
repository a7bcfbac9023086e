#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H

#include "bundle_problem.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace wiimote_tracker::bundle {

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

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H
