#include "constant_noise_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker {
namespace {

/// The acceleration is a random walk. @param density [m^2/s^5]  @param h duration [s]
motion::Transition randomWalkOfAcceleration(double density, double h) {
  motion::Transition result;
  result.F << 1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0;
  result.Q << h * h * h * h / 20.0, h * h * h / 8.0, h * h / 6.0,  //
      h * h * h / 8.0, h * h / 3.0, h / 2.0,                       //
      h * h / 6.0, h / 2.0, 1.0;
  result.Q *= density * h;
  return result;
}

}  // namespace

ConstantNoiseFilter::ConstantNoiseFilter(int order,
                                         double density,
                                         double time,
                                         const Eigen::Vector3d& position,
                                         const Eigen::Matrix3d& covariance,
                                         double pixel_stddev)
    : order_(order), density_(density), time_(time), pixel_variance_(pixel_stddev * pixel_stddev) {
  state_.mean << position, Eigen::Matrix<double, 6, 1>::Zero();
  state_.covariance.setZero();
  state_.covariance.topLeftCorner<3, 3>() = covariance;
  state_.covariance.diagonal().segment<3>(3).setConstant(1.0);  // 1 m/s
  if (order == 3)
    state_.covariance.diagonal().tail<3>().setConstant(100.0);  // 10 m/s^2
}

void ConstantNoiseFilter::predict(double time) {
  if (!(time > time_))
    return;
  state_.predict(order_ == 2 ? motion::randomWalkOfVelocity(std::sqrt(density_), time - time_)
                             : randomWalkOfAcceleration(density_, time - time_));
  time_ = time;
}

void ConstantNoiseFilter::update(const geometry::Camera& camera, const Eigen::Vector2d& pixel) {
  Eigen::Matrix<double, 2, 3> H;
  const auto predicted = camera.project(position(), &H);
  if (!predicted)
    return;
  const Eigen::Matrix2d S = H * state_.positionCovariance() * H.transpose() +
                            pixel_variance_ * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d L = S.llt().matrixL();
  state_.update(H, L.inverse(), pixel - *predicted);
}

}  // namespace wiimote_tracker
