#pragma once

#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker::body {

/// d point / d (position, rotation) of a point of a body, in the world: a small rotation w about
/// the world axes moves it to exp([w]x) arm = arm - [arm]x w. @param arm from the body's origin to
/// it [m]
inline Eigen::Matrix<double, 3, 6> pointByPose(const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -geometry::so3::skew(arm);
  return jacobian;
}

/// Kalman update by a pixel of a state whose first six values are position and rotation.
/// @param jacobian d pixel / d (position, rotation) [px/m, px/rad]. @param innovation [px]
/// @param noise covariance of the pixel [px^2]. @param step what to move the state by.
/// @returns -2 log likelihood of the innovation, without its constant
template <int kSize>
double updateByPixel(const Eigen::Matrix<double, 2, 6>& jacobian,
                     const Eigen::Vector2d& innovation,
                     const Eigen::Matrix2d& noise,
                     Eigen::Matrix<double, kSize, kSize>* covariance,
                     Eigen::Matrix<double, kSize, 1>* step) {
  using Columns = Eigen::Matrix<double, kSize, 2>;
  using Square = Eigen::Matrix<double, kSize, kSize>;
  const Columns PHt = covariance->template leftCols<6>() * jacobian.transpose();
  const Eigen::Matrix2d S = jacobian * PHt.template topRows<6>() + noise;  // of the innovation
  const Eigen::Matrix2d inverse = S.inverse();
  const Columns K = PHt * inverse;  // gain
  *step = K * innovation;

  // Joseph's form keeps the covariance positive definite: (I - K H) P (I - K H)' + K R K'.
  Square reduced = *covariance;  // (I - K H) P
  reduced.noalias() -= K * PHt.transpose();
  const Columns left = reduced.template leftCols<6>() * jacobian.transpose();
  *covariance = reduced;
  covariance->noalias() -= left * K.transpose();
  covariance->noalias() += K * noise * K.transpose();
  const Square symmetric = 0.5 * (*covariance + covariance->transpose());
  *covariance = symmetric;
  return innovation.dot(inverse * innovation) + std::log(S.determinant());
}

}  // namespace wiimote_tracker::body
