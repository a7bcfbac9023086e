#include "wiimote_tracker_calibration/bundle/error.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

#include "reprojection_cost.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <string>

namespace wiimote_tracker::bundle {

namespace {

/// What Ceres varies of one camera.
struct CameraBlocks {
  std::array<double, kIntrinsicsSize> intrinsics;
  Eigen::Vector3d rotation;  // camera_from_world, angle-axis [rad]
  Eigen::Vector3d position;  // optical centre, world [m]
};

CameraBlocks blocksOf(const geometry::Camera& camera) {
  const geometry::Intrinsics& in = camera.intrinsics;
  const auto& k = in.distortion;
  CameraBlocks blocks;
  blocks.intrinsics = {in.fx, in.fy, in.cx, in.cy, k[0], k[1], k[2], k[3], k[4]};
  const Eigen::Matrix3d camera_from_world = camera.world_from_camera.linear().transpose();
  ceres::RotationMatrixToAngleAxis(camera_from_world.data(), blocks.rotation.data());
  blocks.position = camera.center();
  return blocks;
}

void setPose(const CameraBlocks& blocks, geometry::Camera* camera) {
  Eigen::Matrix3d camera_from_world;
  ceres::AngleAxisToRotationMatrix(blocks.rotation.data(), camera_from_world.data());
  camera->world_from_camera.linear() = camera_from_world.transpose();
  camera->world_from_camera.translation() = blocks.position;
}

/// One minimisation over the inliers as they are marked.
void minimize(Reconstruction* reconstruction, const Options& options, const Held& held) {
  std::vector<CameraBlocks> cameras;
  for (const geometry::Camera& camera : reconstruction->cameras)
    cameras.push_back(blocksOf(camera));

  ceres::Problem problem;
  std::vector<bool> seen(cameras.size(), false);
  for (std::size_t i = 0; i < reconstruction->observations.size(); ++i) {
    if (!reconstruction->inliers[i])
      continue;
    const Observation& observation = reconstruction->observations[i];
    CameraBlocks& camera = cameras[observation.camera];
    problem.AddResidualBlock(ReprojectionCost::create(observation.pixel),
                             new ceres::HuberLoss(options.loss_scale), camera.intrinsics.data(),
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
    const bool anchor = i == first && !held.rotations && !held.positions;
    problem.SetParameterBlockConstant(cameras[i].intrinsics.data());
    if (held.rotations || anchor)
      problem.SetParameterBlockConstant(cameras[i].rotation.data());
    if (held.positions || anchor)
      problem.SetParameterBlockConstant(cameras[i].position.data());
  }

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = 200;
  solver.function_tolerance = 1e-14;
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
  for (std::size_t i = 0; i < cameras.size(); ++i)
    setPose(cameras[i], &reconstruction->cameras[i]);
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
