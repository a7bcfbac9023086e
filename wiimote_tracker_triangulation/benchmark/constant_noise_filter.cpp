#include "constant_noise_filter.h"

#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

ConstantNoiseFilter::ConstantNoiseFilter(int order,
                                         double density,
                                         double time,
                                         const Eigen::Vector3d& position,
                                         const Matrix3d& covariance,
                                         double pixel_stddev)
    : order_(order),
      density_(density),
      time_(time),
      pixel_variance_(pixel_stddev * pixel_stddev),
      x_(Eigen::VectorXd::Zero(3 * order)),
      P_(MatrixXd::Zero(3 * order, 3 * order)) {
  x_.head<3>() = position;
  P_.topLeftCorner<3, 3>() = covariance;
  P_.diagonal().segment<3>(3).setConstant(1.0);  // 1 m/s
  if (order == 3)
    P_.diagonal().tail<3>().setConstant(100.0);  // 10 m/s^2
}

void ConstantNoiseFilter::predict(double time) {
  const double h = time - time_;
  if (!(h > 0.0))
    return;
  time_ = time;
  constexpr double kFactorial[] = {1.0, 1.0, 2.0};
  const Eigen::Index n = x_.size();
  MatrixXd F = MatrixXd::Identity(n, n);
  MatrixXd Q = MatrixXd::Zero(n, n);
  for (int i = 0; i < order_; ++i) {
    for (int j = 0; j < order_; ++j) {
      if (j > i)
        F.block<3, 3>(3 * i, 3 * j) = std::pow(h, j - i) / kFactorial[j - i] * Matrix3d::Identity();
      const int a = order_ - 1 - i;
      const int b = order_ - 1 - j;
      Q.block<3, 3>(3 * i, 3 * j) = density_ * std::pow(h, a + b + 1) /
                                    ((a + b + 1) * kFactorial[a] * kFactorial[b]) *
                                    Matrix3d::Identity();
    }
  }
  x_ = (F * x_).eval();
  P_ = (F * P_ * F.transpose() + Q).eval();
}

void ConstantNoiseFilter::update(const geometry::Camera& camera, const Eigen::Vector2d& pixel) {
  Eigen::Matrix<double, 2, 3> H;
  const auto predicted = camera.project(position(), &H);
  if (!predicted)
    return;
  const MatrixXd gain = P_.leftCols(3) * H.transpose();
  Eigen::Matrix2d S = H * gain.topRows(3);
  S.diagonal().array() += pixel_variance_;
  const MatrixXd K = gain * S.inverse();
  x_ += K * (pixel - *predicted);
  P_ -= (K * gain.transpose()).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

}  // namespace wiimote_tracker
