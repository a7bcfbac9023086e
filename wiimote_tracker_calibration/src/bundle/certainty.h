#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H

#include "wiimote_tracker_calibration/bundle/reconstruction.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// Standard deviation of one pixel coordinate, estimated from the residuals of the inliers [px].
/// @param fixed_lenses the lenses were held: no degrees of freedom went into them.
double pixelStddev(const Reconstruction& reconstruction, const Options& options, bool fixed_lenses);

/// Covariance of the lenses and poses of an adjusted reconstruction, to first order: the inverse of
/// the information of the inliers, the points eliminated (Schur complement), with pixelStddev().
/// The adjustment's Huber loss hardly changes it (test_self_calibrate.cpp). Options::lens counts
/// too, but not its focal length.
class Certainty {
 public:
  /// @param fixed_lenses the lenses are given, and exact.
  Certainty(const Reconstruction& reconstruction, const Options& options, bool fixed_lenses);

  /// Covariance of a lens in the order fx, fy, cx, cy, k1, k2, p1, p2, k3. Nothing when the
  /// observations leave some parameter open.
  std::optional<Eigen::MatrixXd> lensCovariance(std::size_t camera) const;

  /// How far a lens is from the optimum of these observations, to first order, in the same order:
  /// zero for those that were adjusted, and for others a Gauss-Newton step.
  Eigen::VectorXd lensStep(std::size_t camera) const;

  /// Expected RMS distance of the points from the truth after the best similarity [unit of the
  /// points], from the errors of cameras, lenses and pixels together. Nothing when some parameter
  /// is open.
  std::optional<double> expectedShapeError() const;

 private:
  struct Point {
    Eigen::Vector3d position;
    Eigen::Matrix3d covariance;      ///< The cameras being exact.
    Eigen::Matrix3Xd by_parameters;  ///< How it moves with the lenses and poses.
  };

  Eigen::Index lensColumn(std::size_t camera) const;
  Eigen::Index poseColumn(std::size_t camera) const;
  void addObservations(const Reconstruction& reconstruction, double stddev);
  void addLensPrior(const Reconstruction& reconstruction, const Options& options);
  void fixWorld(const Reconstruction& reconstruction);

  const bool one_lens_;
  const std::size_t camera_count_;
  std::vector<Point> points_;                  // with two views or more
  Eigen::MatrixXd information_;                // of lenses, then poses
  Eigen::VectorXd gradient_;                   // of the same: covariance times this is the step
  std::optional<Eigen::MatrixXd> covariance_;  // of the same
};

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H
