#pragma once

#include "motion/transition.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::motion {

/// Normal distribution of an LED's position, velocity and acceleration, in this order, in the world
/// [m, s].
struct KinematicState {
  Eigen::Matrix<double, 9, 1> mean;
  Eigen::Matrix<double, 9, 9> covariance;

  Eigen::Vector3d position() const { return mean.head<3>(); }
  Eigen::Vector3d velocity() const { return mean.segment<3>(3); }
  Eigen::Matrix3d positionCovariance() const { return covariance.topLeftCorner<3, 3>(); }
  Eigen::Matrix3d velocityCovariance() const { return covariance.block<3, 3>(3, 3); }

  /// The same transition in each axis: x' = (F (x) I) x + noise of the covariance Q (x) I.
  void predict(const Transition& transition);

  /// Kalman update by a pixel, of the first N components; the others are exactly known.
  /// @param jacobian d pixel / d position [px/m]
  /// @param whitening L^-1 of the innovation covariance L L^T, lower triangular [1/px]
  /// @param innovation [px]
  /// @param considered a direction of length 1, if nothing is to be learned of the components along
  /// it: their errors are only considered (the Schmidt-Kalman filter)
  template <int N = 9>
  void update(const Eigen::Matrix<double, 2, 3>& jacobian,
              const Eigen::Matrix2d& whitening,
              const Eigen::Vector2d& innovation,
              const std::optional<Eigen::Vector3d>& considered = std::nullopt) {
    // With the innovation covariance S = L L^T and W = P H^T L^-T: the gain is W L^-1, and the
    // covariance becomes P - W W^T.
    const Eigen::Matrix<double, 3, 2> whitened = jacobian.transpose() * whitening.transpose();
    Eigen::Matrix<double, N, 2> W = covariance.topLeftCorner<N, 3>() * whitened;
    covariance.topLeftCorner<N, N>() -= W.lazyProduct(W.transpose());
    if (considered) {
      // Any other gain K makes the covariance P - K H P - (K H P)^T + K S K^T.
      Eigen::Matrix<double, N, 2> along;
      for (int i = 0; i < N; i += 3)
        along.template middleRows<3>(i) =
            *considered * considered->transpose().lazyProduct(W.template middleRows<3>(i));
      covariance.topLeftCorner<N, N>() += along.lazyProduct(along.transpose());
      W -= along;
    }
    mean.head<N>() += W * (whitening * innovation);
  }

  /// Along a direction, velocity and acceleration are multiplied by `kept` and get noise, so that
  /// with kept = 0 they have these variances. @param direction of length 1  @param kept [0..1]
  void decay(const Eigen::Vector3d& direction,
             double kept,
             double velocity_variance,
             double acceleration_variance);
};

}  // namespace wiimote_tracker::motion
