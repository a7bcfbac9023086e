#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::adjust {

/// Gaussian prior of all values of several parameter blocks, which may be correlated, whitened.
/// Blocks: the values side by side.
class JointPrior : public ceres::CostFunction {
 public:
  /// @param covariance positive definite. @param sizes of the blocks.
  JointPrior(const Eigen::VectorXd& mean,
             const Eigen::MatrixXd& covariance,
             const std::vector<std::int32_t>& sizes)
      : mean_(mean),
        whitening_(Eigen::LLT<Eigen::MatrixXd>(covariance)
                       .matrixL()
                       .solve(Eigen::MatrixXd::Identity(mean.size(), mean.size()))) {
    set_num_residuals(static_cast<int>(mean.size()));
    *mutable_parameter_block_sizes() = sizes;
  }

  bool Evaluate(double const* const* blocks, double* residual, double** jacobians) const override {
    Eigen::VectorXd error = -mean_;
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const Eigen::Index size = parameter_block_sizes()[i];
      error.segment(first, size) += Eigen::Map<const Eigen::VectorXd>(blocks[i], size);
      if (jacobians && jacobians[i])
        Eigen::Map<Rows>(jacobians[i], mean_.size(), size) = whitening_.middleCols(first, size);
      first += size;
    }
    Eigen::Map<Eigen::VectorXd>(residual, mean_.size()) = whitening_ * error;
    return true;
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::VectorXd mean_;
  Eigen::MatrixXd whitening_;
};

}  // namespace wiimote_tracker::adjust
