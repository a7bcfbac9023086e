#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_KINEMATIC_STATE_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_KINEMATIC_STATE_H

#include "wiimote_tracker_triangulation/motion/singer_step.h"

#include <Eigen/Core>

namespace wiimote_tracker::motion {

/// A pixel less its prediction, whitened: of unit covariance in both coordinates when all is as
/// the state says.
struct Innovation {
  Eigen::Matrix<double, 2, 3> jacobian;  ///< d pixel / d position [px/m].
  Eigen::Matrix2d whiten;                ///< Lower triangle; times [px] = [1].
  Eigen::Vector2d whitened;              ///< [1]

  /// Of its density [1/px^2].
  double logLikelihood() const;
};

/// Lower triangle that whitens an innovation of covariance H P H^T + R: the inverse of that
/// covariance's Cholesky factor [1/px].
Eigen::Matrix2d whitening(const Eigen::Matrix<double, 2, 3>& jacobian,
                          const Eigen::Matrix3d& position_covariance,
                          const Eigen::Matrix2d& pixel_covariance);

/// Normal distribution of an LED's position, velocity and acceleration in the world [m, s]: the
/// mean and the nine 3x3 blocks of the covariance, of which three are another's transpose.
struct KinematicState {
  Eigen::Vector3d p, v, a;
  Eigen::Matrix3d pp, pv, pa, vv, va, aa;

  /// One step of the Singer model. @param variance of the acceleration per axis [m^2/s^4]
  void predict(const SingerStep& step, double variance);

  /// Kalman update with a measurement of the position's image.
  void update(const Innovation& innovation);

  /// *this += weight * other, as far as means go: for a weighted mean.
  void addMean(double weight, const KinematicState& other);

  /// Adds a component's covariance and spread about this mean, for a mixture's covariance.
  void addCovariance(double weight, const KinematicState& other);

  void setMeanZero();
  void setCovarianceZero();
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_KINEMATIC_STATE_H
