#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_ADJUSTMENT_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_ADJUSTMENT_H

#include "state.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace wiimote_tracker::wave {

/// How a refinement went.
struct Refinement {
  /// Chi-squared of the corners and of the priors, and its degrees of freedom.
  double chi_squared;
  int degrees_of_freedom;
  /// Square root of the mean whitened squared residual of the matches, corrected for the parameters
  /// that were fitted: 1 when the matches' standard deviations are right. Where the redundancy is
  /// not known, without this correction, and at least 1.
  double misfit;
  /// Residuals of the matches beyond the number of those parameters, as a share of all. Below 0.1
  /// it is not known and stated as 1: the prior of the accelerations, which is not counted, then
  /// determines a good part of the path.
  double redundancy;
};

/// Least squares over the matches, the corners, the wand and the priors
/// (Levenberg-Marquardt, in place).
/// @param loss_scale the error beyond which a match counts less (Cauchy), in standard deviations;
/// infinite: plain least squares.
/// @param keep_going is asked before each iteration; false throws Cancelled.
/// @throws WaveError: the minimisation fails.
Refinement refine(const Recording& recording,
                  const WaveOptions& options,
                  const std::vector<Match>& matches,
                  double loss_scale,
                  const std::function<bool()>& keep_going,
                  State* state);

/// Joint covariance at a solution of plain least squares: of the cameras, in the order of
/// geometry::Rig::covariance, then of the corners (2 each), if there are any.
/// @throws WaveError: the recording does not determine some parameter.
Eigen::MatrixXd covarianceOf(const Recording& recording,
                             const WaveOptions& options,
                             const std::vector<Match>& matches,
                             State solution);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_ADJUSTMENT_H
