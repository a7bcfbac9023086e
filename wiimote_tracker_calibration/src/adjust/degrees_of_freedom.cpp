#include "adjust/degrees_of_freedom.h"

#include "adjust/covariance.h"
#include "adjust/jacobian.h"

#include <unordered_set>

namespace wiimote_tracker::adjust {

double degreesOfFreedom(ceres::Problem* problem,
                        const std::vector<ceres::ResidualBlockId>& residuals) {
  std::vector<double*> blocks;
  std::unordered_set<const double*> taken;
  for (const ceres::ResidualBlockId residual : residuals) {
    std::vector<double*> own;
    problem->GetParameterBlocksForResidualBlock(residual, &own);
    for (double* block : own) {
      if (!problem->IsParameterBlockConstant(block) && taken.insert(block).second)
        blocks.push_back(block);
    }
  }
  const Eigen::MatrixXd jacobian = jacobianOf(problem, residuals, blocks);
  const auto count = static_cast<double>(jacobian.rows());
  const auto covariance = covarianceOf(problem, blocks);
  return covariance ? count - (jacobian * *covariance).cwiseProduct(jacobian).sum() : count;
}

}  // namespace wiimote_tracker::adjust
