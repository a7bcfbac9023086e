#pragma once

#include "state.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace wiimote_tracker::wave {

/// How a refinement went.
struct Refinement {
  /// Residuals of the matches beyond the number of parameters that were fitted, as a share of all.
  /// Nothing below 0.1: the prior of the accelerations, which is not counted, then determines a
  /// good part of the path.
  std::optional<double> redundancy;
  /// Square root of the mean whitened squared residual of the matches over the redundancy, if that
  /// is known: then 1 when the matches' standard deviations are right.
  double noise_ratio;
};

/// How well corners, wand, floor and priors agree with a solution of plain least squares.
struct Agreement {
  double chi_squared;
  double degrees_of_freedom;  ///< Expectation of chi_squared.

  /// Whether the disagreement is significant (99.9 %).
  bool isContradiction() const;
};

/// Least squares over the matches, the corners, the wand, the floor and the priors
/// (Levenberg-Marquardt, in place).
/// @param loss_scale the error beyond which a match counts less (Cauchy), in standard deviations;
/// infinite: plain least squares.
/// @param report is called before each iteration; what it throws ends the work.
/// @throws WaveError: the minimisation fails.
Refinement refine(const Task& task,
                  const std::vector<Match>& matches,
                  double loss_scale,
                  const std::function<void()>& report,
                  State* state);

Agreement agreementOf(const Task& task, const std::vector<Match>& matches, State solution);

/// Joint covariance at a solution of plain least squares: of the cameras, in the order of
/// geometry::Rig::covariance, then of the corners (2 each), if there are any.
/// @throws WaveError: the recording does not determine some parameter.
Eigen::MatrixXd covarianceOf(const Task& task, const std::vector<Match>& matches, State solution);

}  // namespace wiimote_tracker::wave
