#pragma once

#include <ceres/normal_prior.h>

#include <Eigen/Core>

namespace wiimote_tracker::adjust {

/// Gaussian prior of independent values, whitened: the place of a corner, the length of a wand, the
/// offset of a clock, distortion coefficients. Block: the values.
inline ceres::CostFunction* priorOf(const Eigen::VectorXd& mean, const Eigen::VectorXd& stddev) {
  return new ceres::NormalPrior(Eigen::MatrixXd(stddev.cwiseInverse().asDiagonal()), mean);
}
inline ceres::CostFunction* priorOf(double mean, double stddev) {
  return priorOf(Eigen::VectorXd::Constant(1, mean), Eigen::VectorXd::Constant(1, stddev));
}

}  // namespace wiimote_tracker::adjust
