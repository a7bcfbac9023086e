#include "single_model_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace wiimote_tracker {

void SingleModelFilter::predict(double to) {
  if (!(to > time))
    return;
  state.predict(model(to - time));
  time = to;
}

double SingleModelFilter::update(const geometry::Camera& camera,
                                 const Eigen::Vector2d& pixel,
                                 const Eigen::Vector3d& place) {
  Eigen::Matrix<double, 2, 3> H;
  const auto at_place = camera.project(place, &H);
  if (!at_place)
    return -std::numeric_limits<double>::infinity();
  const Eigen::Vector2d innovation = pixel - *at_place - H * (state.position() - place);
  const Eigen::Matrix2d S = H * state.positionCovariance() * H.transpose() +
                            pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d L = S.llt().matrixL();
  const Eigen::Matrix2d whitening = L.inverse();
  state.update(H, whitening, innovation);
  return -0.5 * (whitening * innovation).squaredNorm() - std::log(L.determinant());
}

motion::KinematicState stateAt(const Eigen::Vector3d& position,
                               const Eigen::Matrix3d& covariance,
                               double speed,
                               double acceleration) {
  motion::KinematicState state;
  state.mean << position, Eigen::Matrix<double, 6, 1>::Zero();
  state.covariance.setZero();
  state.covariance.topLeftCorner<3, 3>() = covariance;
  state.covariance.diagonal().segment<3>(3).setConstant(speed * speed);
  state.covariance.diagonal().tail<3>().setConstant(acceleration * acceleration);
  return state;
}

}  // namespace wiimote_tracker
