#include "adjust/covariance.h"

#include <wiimote_tracker_msgs/error.h>

#include <ceres/crs_matrix.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstddef>
#include <unordered_set>

namespace wiimote_tracker::adjust {

namespace {

// Smallest share of a parameter's information that may be left when those that are eliminated
// before it are unknown (a pivot of the scaled matrix); below, it is rounding error.
constexpr double kOpen = 1e-13;

/// The whitened residuals' derivatives, with the rows and columns that the options ask for; empty
/// where one of them is not defined. @param gradient of half the sum of squares, by the columns.
Eigen::SparseMatrix<double, Eigen::RowMajor> jacobianOf(
    ceres::Problem* problem,
    const ceres::Problem::EvaluateOptions& options,
    std::vector<double>* gradient = nullptr) {
  ceres::CRSMatrix rows;
  if (!problem->Evaluate(options, nullptr, nullptr, gradient, &rows))
    return {};
  return Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
}

/// J^T J by the blocks that are estimated, the wanted ones first.
/// @throws Error: a block has fewer columns than parameters, which would shift those after it.
Eigen::SparseMatrix<double> informationOf(ceres::Problem* problem,
                                          const std::vector<double*>& wanted,
                                          std::vector<double>* gradient) {
  ceres::Problem::EvaluateOptions options;
  std::vector<double*> all;
  problem->GetParameterBlocks(&all);
  all.insert(all.begin(), wanted.begin(), wanted.end());
  std::unordered_set<const double*> taken;
  int parameters = 0;
  for (double* block : all) {
    if (taken.insert(block).second && !problem->IsParameterBlockConstant(block)) {
      options.parameter_blocks.push_back(block);
      parameters += problem->ParameterBlockSize(block);
    }
  }
  const Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian =
      jacobianOf(problem, options, gradient);
  // Not ParameterBlockTangentSize(), which Ceres 1.14 calls ParameterBlockLocalSize().
  if (jacobian.size() > 0 && jacobian.cols() != parameters)
    throw Error("the covariance of a block of which a part is held is not known: hold it whole");
  return jacobian.transpose() * jacobian;
}

}  // namespace

std::optional<Estimate> estimateOf(ceres::Problem* problem, const std::vector<double*>& blocks) {
  std::vector<Eigen::Index> places;  // in the result, of the parameters that are estimated
  Eigen::Index size = 0;
  for (double* block : blocks) {
    for (int i = 0; i < problem->ParameterBlockSize(block); ++i, ++size) {
      if (!problem->IsParameterBlockConstant(block))
        places.push_back(size);
    }
  }
  std::vector<double> gradient;
  const Eigen::SparseMatrix<double> information = informationOf(problem, blocks, &gradient);
  // Parameters of very different units: scaled to a unit diagonal.
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (information.size() == 0 || !scale.allFinite())
    return std::nullopt;
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(scaled);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > kOpen))
    return std::nullopt;
  const auto wanted = static_cast<Eigen::Index>(places.size());
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(scaled.rows(), wanted);
  const Eigen::MatrixXd inverse = factor.solve(unit);
  const Eigen::VectorXd descent = -Eigen::Map<const Eigen::VectorXd>(
      gradient.data(), static_cast<Eigen::Index>(gradient.size()));
  const Eigen::VectorXd step =
      scale.head(wanted).cwiseProduct(inverse.transpose() * scale.cwiseProduct(descent));
  Estimate result{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (Eigen::Index i = 0; i < wanted; ++i) {
    const Eigen::Index row = places[static_cast<std::size_t>(i)];
    result.step(row) = step(i);
    for (Eigen::Index j = 0; j < wanted; ++j)
      result.covariance(row, places[static_cast<std::size_t>(j)]) =
          scale(i) * scale(j) * inverse(i, j);
  }
  // Symmetric to the last bit.
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  return result;
}

std::optional<Eigen::MatrixXd> covarianceOf(ceres::Problem* problem,
                                            const std::vector<double*>& blocks) {
  const auto estimate = estimateOf(problem, blocks);
  return estimate ? std::optional(estimate->covariance) : std::nullopt;
}

double squaresOf(ceres::Problem* problem, const std::vector<ceres::ResidualBlockId>& residuals) {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = residuals;
  options.apply_loss_function = false;
  double half_sum = 0.0;
  problem->Evaluate(options, &half_sum, nullptr, nullptr, nullptr);
  return 2.0 * half_sum;
}

double degreesOfFreedom(ceres::Problem* problem,
                        const std::vector<ceres::ResidualBlockId>& residuals) {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = residuals;
  std::unordered_set<const double*> taken;
  for (const ceres::ResidualBlockId residual : residuals) {
    std::vector<double*> own;
    problem->GetParameterBlocksForResidualBlock(residual, &own);
    for (double* block : own) {
      if (!problem->IsParameterBlockConstant(block) && taken.insert(block).second)
        options.parameter_blocks.push_back(block);
    }
  }
  const Eigen::MatrixXd jacobian = jacobianOf(problem, options);
  const auto count = static_cast<double>(jacobian.rows());
  const auto covariance = covarianceOf(problem, options.parameter_blocks);
  return covariance ? count - (jacobian * *covariance).cwiseProduct(jacobian).sum() : count;
}

}  // namespace wiimote_tracker::adjust
