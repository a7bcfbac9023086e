#pragma once

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <vector>

namespace wiimote_tracker::adjust {

/// Where a minimisation ends: relative change of the sum of squares, gradient, relative change of
/// the parameters. The defaults are those of Ceres.
struct Tolerances {
  double function = 1e-6;
  double gradient = 1e-10;
  double parameter = 1e-8;
};

/// What all minimisations have in common.
inline ceres::Solver::Options solverOptions(ceres::LinearSolverType type,
                                            int iterations,
                                            const Tolerances& tolerances = {}) {
  ceres::Solver::Options options;
  options.linear_solver_type = type;
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerances.function;
  options.gradient_tolerance = tolerances.gradient;
  options.parameter_tolerance = tolerances.parameter;
  options.num_threads = 1;  // the same bits on every run
  options.logging_type = ceres::SILENT;
  return options;
}

/// The same for cameras and many points, which are eliminated first (Schur complement).
/// @param points blocks of the problem, at most one of them in each residual.
inline ceres::Solver::Options solverOptionsForPoints(const ceres::Problem& problem,
                                                     const std::vector<double*>& points,
                                                     int iterations,
                                                     const Tolerances& tolerances = {}) {
  ceres::Solver::Options options = solverOptions(ceres::DENSE_SCHUR, iterations, tolerances);
  options.linear_solver_ordering.reset(new ceres::ParameterBlockOrdering);
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  for (double* const block : blocks)
    options.linear_solver_ordering->AddElementToGroup(block, 1);
  for (double* const point : points)
    options.linear_solver_ordering->AddElementToGroup(point, 0);
  return options;
}

/// Levenberg-Marquardt, in place.
inline ceres::Solver::Summary minimise(const ceres::Solver::Options& options,
                                       ceres::Problem* problem) {
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  return summary;
}

}  // namespace wiimote_tracker::adjust
