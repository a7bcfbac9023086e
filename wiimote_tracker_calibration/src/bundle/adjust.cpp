#include "wiimote_tracker_calibration/bundle/error.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

#include "camera_blocks.h"
#include "reprojection_cost.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <string>

namespace wiimote_tracker::bundle {

namespace {

/// One minimisation over the inliers as they are marked.
void minimize(Reconstruction* reconstruction, const Options& options, const Held& held) {
  std::vector<CameraBlocks> cameras;
  for (const geometry::Camera& camera : reconstruction->cameras)
    cameras.push_back(blocksOf(camera));

  // Cameras with one lens vary the first one's.
  const auto lensOf = [&](std::size_t camera) {
    return cameras[options.one_lens ? 0 : camera].intrinsics.data();
  };
  ceres::Problem problem;
  std::vector<bool> seen(cameras.size(), false);
  for (std::size_t i = 0; i < reconstruction->observations.size(); ++i) {
    if (!reconstruction->inliers[i])
      continue;
    const Observation& observation = reconstruction->observations[i];
    CameraBlocks& camera = cameras[observation.camera];
    const geometry::Intrinsics& lens = reconstruction->cameras[observation.camera].intrinsics;
    problem.AddResidualBlock(ReprojectionCost::create(observation.pixel, lens.distortion_model),
                             new ceres::HuberLoss(options.loss_scale), lensOf(observation.camera),
                             camera.rotation.data(), camera.position.data(),
                             reconstruction->points[observation.point]->data());
    seen[observation.camera] = true;
  }
  if (problem.NumResidualBlocks() == 0)
    throw BundleError(
        "no point is seen by two cameras that agree on it from different directions: check the "
        "cameras' intrinsics and that they do not stand in one place");

  const auto first = static_cast<std::size_t>(
      std::distance(seen.begin(), std::find(seen.begin(), seen.end(), true)));
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!seen[i])
      continue;
    // World and camera would otherwise be free to move together.
    const bool anchor = i == first && !held.rotations && !held.positions && !held.points;
    if (held.rotations || anchor)
      problem.SetParameterBlockConstant(cameras[i].rotation.data());
    if (held.positions || anchor)
      problem.SetParameterBlockConstant(cameras[i].position.data());
  }

  for (std::size_t i = 0; i < (options.one_lens ? 1 : cameras.size()); ++i) {
    if (!problem.HasParameterBlock(lensOf(i)))
      continue;
    if (held.intrinsics)
      problem.SetParameterBlockConstant(lensOf(i));
    else
      problem.AddResidualBlock(LensPriorCost::create(reconstruction->cameras[i].intrinsics,
                                                     options.lens, options.pixel_stddev),
                               nullptr, lensOf(i));
  }
  if (held.points) {
    for (auto& point : reconstruction->points) {
      if (point && problem.HasParameterBlock(point->data()))
        problem.SetParameterBlockConstant(point->data());
    }
  }

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = options.rough ? 20 : 200;
  solver.function_tolerance = options.rough ? 1e-4 : 1e-14;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-14;
  // The scale is free, so the normal equations are singular but for the damping: keep some of it.
  solver.max_trust_region_radius = 1e8;
  solver.num_threads = 1;  // the same bits on every run
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable())
    throw BundleError("the adjustment failed (" + summary.message +
                      "): record the light in more places");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (options.one_lens)
      cameras[i].intrinsics = cameras[0].intrinsics;
    setCamera(cameras[i], &reconstruction->cameras[i]);
  }
}

}  // namespace

void adjust(Reconstruction* reconstruction, const Options& options, const Held& held) {
  // A camera without any inlier stays where it is and is not asked about points.
  const int kMaximumRounds = 20;
  std::vector<bool> usable(reconstruction->cameras.size(), false);
  for (std::size_t i = 0; i < reconstruction->observations.size(); ++i)
    usable[reconstruction->observations[i].camera] =
        usable[reconstruction->observations[i].camera] || reconstruction->inliers[i];
  for (int round = 0; round < kMaximumRounds; ++round) {
    minimize(reconstruction, options, held);
    if (options.rough)
      return;
    const std::vector<bool> before = reconstruction->inliers;
    const auto points = reconstruction->points;
    triangulatePoints(reconstruction, usable, options.maximum_error, options.minimum_angle);
    if (reconstruction->inliers == before) {
      reconstruction->points = points;
      return;
    }
  }
}

}  // namespace wiimote_tracker::bundle
