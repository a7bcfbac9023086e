#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_ADJUSTMENT_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_ADJUSTMENT_H

#include "band_matrix.h"
#include "projection.h"
#include "state.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace wiimote_tracker::wave {

/// The least-squares problem: residuals of the matches, of the corners, of the wand, and what is
/// known beforehand. Its normal equations are a band (the path: 3 per LED and control point)
/// bordered by the parameters of the cameras, the corners and the wand, so that an iteration costs
/// as much as the matches do, and the path next to nothing.
class Adjustment {
 public:
  /// @param nominal_corners empty without square.
  Adjustment(const Recording& recording,
             const WaveOptions& options,
             std::vector<Eigen::Vector3d> nominal_corners,
             Gauge gauge);

  /// Which matches to fit, and the error beyond which one counts less (Cauchy) in standard
  /// deviations; infinite: plain least squares.
  void use(std::vector<Match> matches, double loss_scale);

  /// Levenberg-Marquardt. @param keep_going is asked before each iteration; false throws Cancelled.
  /// @returns the number of iterations. @throws WaveError when it fails.
  int solve(State* state, const std::function<bool()>& keep_going);

  /// Joint covariance of the cameras (kCameraSize each), then the corners (2 each), at a solution.
  Eigen::MatrixXd covariance(const State& state);

  /// Square root of the mean whitened squared residual of the matches, corrected for the
  /// parameters that were fitted: 1 when their standard deviations are right.
  double misfit(const State& state) const;

 private:
  /// Half the sum of squares; infinite where a match cannot be projected.
  double cost(const State& state) const;
  void linearize(const State& state);
  void addMatches(const State& state);
  void addPaths(const State& state);
  void addCorners(const State& state);
  void addLenses(const State& state);
  void holdGauge();
  bool step(double damping, Eigen::VectorXd* border, Eigen::VectorXd* path) const;
  State moved(const State& state, const Eigen::VectorXd& border, const Eigen::VectorXd& path) const;
  Eigen::Index cornerColumn() const;
  Eigen::Index wandColumn() const;

  const Recording& recording_;
  const WaveOptions& options_;
  const std::vector<Eigen::Vector3d> nominal_corners_;
  const Gauge gauge_;
  std::vector<Match> matches_;
  double loss_scale_ = 0.0;
  std::vector<bool> seen_;  // Per knot interval: some match lies in it.

  // Normal equations: [band, coupling; coupling^T, border] step = -gradient.
  std::optional<BandMatrix> band_;
  RowMajorMatrix coupling_;
  Eigen::MatrixXd border_;  // lower triangle
  Eigen::VectorXd path_gradient_;
  Eigen::VectorXd border_gradient_;
};

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_ADJUSTMENT_H
