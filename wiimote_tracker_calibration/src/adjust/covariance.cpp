#include "adjust/covariance.h"

#include <ceres/covariance.h>

namespace wiimote_tracker::adjust {

std::optional<Eigen::MatrixXd> covarianceOf(ceres::Problem* problem,
                                            const std::vector<double*>& blocks) {
  Eigen::Index size = 0;
  for (const double* block : blocks)
    size += problem->ParameterBlockSize(block);
  const std::vector<const double*> wanted(blocks.begin(), blocks.end());
  ceres::Covariance covariance{ceres::Covariance::Options()};
  Eigen::MatrixXd result(size, size);
  if (!covariance.Compute(wanted, problem) ||
      !covariance.GetCovarianceMatrix(wanted, result.data()) || !result.allFinite())
    return std::nullopt;
  return 0.5 * (result + result.transpose());  // symmetric to the last bit
}

}  // namespace wiimote_tracker::adjust
