#pragma once

#include <ceres/problem.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::adjust {

/// What a problem tells at its present values of some parameter blocks, in their order.
struct Estimate {
  Eigen::MatrixXd covariance;  ///< As covarianceOf().
  Eigen::VectorXd step;        ///< To the solution, to first order (Gauss-Newton).
};

/// Nothing and throws as covarianceOf().
std::optional<Estimate> estimateOf(ceres::Problem* problem, const std::vector<double*>& blocks);

/// Joint covariance of some parameter blocks of a problem at its present values, in this order:
/// the inverse of J^T J, with the whitened residuals' Jacobian J by all blocks of the problem.
/// A block is held as a whole or not at all; held blocks have zero rows. Nothing when the residuals
/// do not determine some parameter. Uses a sparse Cholesky factor and solves only these
/// blocks' columns: ceres::Covariance factors J itself (QR), which takes more than a minute for a
/// long wave.
/// @throws Error: only a part of a block is held (a subset parameterization or manifold).
std::optional<Eigen::MatrixXd> covarianceOf(ceres::Problem* problem,
                                            const std::vector<double*>& blocks);

/// Sum of squares of some residuals at the present values of a problem, loss functions aside.
double squaresOf(ceres::Problem* problem, const std::vector<ceres::ResidualBlockId>& residuals);

/// What to expect of the sum of squares of some whitened residuals at the solution of a problem
/// without loss functions: their number less what the fit takes, the trace of J C J^T with their
/// Jacobian J and the covariance C of the parameters (Foerstner 1979: redundancy numbers). Their
/// number when some parameter is not determined.
double degreesOfFreedom(ceres::Problem* problem,
                        const std::vector<ceres::ResidualBlockId>& residuals);

}  // namespace wiimote_tracker::adjust
