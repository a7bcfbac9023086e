#include "adjust/jacobian.h"

#include <ceres/crs_matrix.h>

namespace wiimote_tracker::adjust {

Eigen::MatrixXd jacobianOf(ceres::Problem* problem,
                           const std::vector<ceres::ResidualBlockId>& residuals,
                           const std::vector<double*>& blocks) {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = residuals;
  options.parameter_blocks = blocks;
  ceres::CRSMatrix sparse;
  problem->Evaluate(options, nullptr, nullptr, nullptr, &sparse);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k)
      dense(row, sparse.cols[k]) = sparse.values[k];
  }
  return dense;
}

}  // namespace wiimote_tracker::adjust
