#pragma once

#include "adjust/camera_blocks.h"
#include "adjust/covariance.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

#include <ceres/problem.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// The inliers of a reconstruction and the priors of its lenses as a problem of Ceres. Residuals in
/// px.
class BundleProblem {
 public:
  /// @param reconstruction changed by solve(); must outlive the problem.
  /// @throws BundleError: it has no inliers.
  BundleProblem(Reconstruction* reconstruction, const Options& options);

  /// @returns whether it converged. @throws BundleError: the minimisation fails.
  bool solve();

  /// Adds what no observation shows: how far the farthest camera is from the first.
  void addScale();

  /// Joint covariance of the lenses (fx, fy, cx, cy, k1, k2, p1, p2, k3 of each camera) and then of
  /// some points (3 each), for residuals of standard deviation 1 px, and how far they are from the
  /// optimum. Nothing when a parameter is open.
  std::optional<adjust::Estimate> estimate(const std::vector<std::size_t>& points);

 private:
  /// Cameras with one lens vary the first one's.
  adjust::CameraBlocks& lensOf(std::size_t camera) {
    return cameras_[options_.one_lens ? 0 : camera];
  }

  void addObservations();
  void holdPoses();
  void holdLensOrAddPrior(std::size_t index);

  Reconstruction& reconstruction_;
  const Options options_;
  std::vector<adjust::CameraBlocks> cameras_;
  std::vector<double*> points_;
  ceres::Problem problem_;
};

}  // namespace wiimote_tracker::bundle
