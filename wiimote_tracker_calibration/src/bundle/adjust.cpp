#include "bundle_problem.h"

#include "adjust/lens_prior.h"
#include "adjust/pixel.h"
#include "adjust/prior.h"
#include "adjust/solver.h"

#include <ceres/loss_function.h>
#include <ceres/normal_prior.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::bundle {

BundleProblem::BundleProblem(Reconstruction* reconstruction, const Options& options)
    : reconstruction_(*reconstruction), options_(options) {
  for (const geometry::Camera& camera : reconstruction->cameras)
    cameras_.emplace_back(camera);
  addObservations();
  holdPoses();
  for (std::size_t i = 0; i < (options.one_lens ? 1 : cameras_.size()); ++i)
    holdLensOrAddPrior(i);
}

void BundleProblem::addObservations() {
  for (std::size_t i = 0; i < reconstruction_.observations.size(); ++i) {
    if (!reconstruction_.inliers[i])
      continue;
    const Observation& observation = reconstruction_.observations[i];
    adjust::CameraBlocks& camera = cameras_[observation.camera];
    adjust::CameraBlocks& lens = lensOf(observation.camera);
    double* const point = reconstruction_.points[observation.point]->data();
    const adjust::PixelError error(camera, observation.pixel, 1.0);
    problem_.AddResidualBlock(
        error.cost(),
        std::isfinite(options_.loss_scale) ? new ceres::HuberLoss(options_.loss_scale) : nullptr,
        camera.rotation(), camera.position(), lens.lens(), lens.higherDistortion(), point);
    points_.push_back(point);
  }
  if (problem_.NumResidualBlocks() == 0)
    throw BundleError(
        "no point is seen by two cameras that agree on it from different directions: check the "
        "cameras' intrinsics and that they do not stand in one place");
}

/// One camera keeps its pose, unless something else fixes the world.
void BundleProblem::holdPoses() {
  bool world_fixed = options_.fixed_positions;
  for (adjust::CameraBlocks& camera : cameras_) {
    if (!problem_.HasParameterBlock(camera.rotation()))
      continue;
    if (!world_fixed)
      problem_.SetParameterBlockConstant(camera.rotation());
    if (options_.fixed_positions || !world_fixed)
      problem_.SetParameterBlockConstant(camera.position());
    world_fixed = true;
  }
}

void BundleProblem::holdLensOrAddPrior(std::size_t index) {
  adjust::CameraBlocks& camera = cameras_[index];
  if (!problem_.HasParameterBlock(camera.lens()))
    return;
  if (options_.fixed_lenses) {
    problem_.SetParameterBlockConstant(camera.lens());
    problem_.SetParameterBlockConstant(camera.higherDistortion());
    return;
  }
  const ExpectedLens& expected = options_.lens;
  const double weight = 1.0 / options_.pixel_stddev;  // residuals are in px
  geometry::Intrinsics mean = reconstruction_.cameras[index].intrinsics;
  mean.fx = mean.fy =
      expected.focal_about > 0.0 ? expected.focal_about * mean.width : std::sqrt(mean.fx * mean.fy);
  mean.cx = 0.5 * (mean.width - 1);
  mean.cy = 0.5 * (mean.height - 1);
  mean.distortion = {};
  const adjust::LensPrior lens{mean, expected.focal_length * weight, expected.aspect * weight,
                               expected.principal_point * mean.width * weight,
                               expected.distortion[0] * weight};
  problem_.AddResidualBlock(lens.cost(), nullptr, camera.lens());
  const Eigen::Map<const Eigen::Vector4d> distortion(expected.distortion.data() + 1);
  problem_.AddResidualBlock(adjust::priorOf(Eigen::Vector4d::Zero(), weight * distortion), nullptr,
                            camera.higherDistortion());
}

void BundleProblem::addScale() {
  const double kWeight = 1e4;  // any will do; about that of the observations
  const Eigen::Vector3d origin = reconstruction_.cameras.front().center();
  const auto from_origin = [&](const geometry::Camera& camera) {
    return (camera.center() - origin).norm();
  };
  const auto& cameras = reconstruction_.cameras;
  const auto farthest = std::max_element(
      cameras.begin(), cameras.end(),
      [&](const auto& a, const auto& b) { return from_origin(a) < from_origin(b); });
  double* const position =
      cameras_[static_cast<std::size_t>(farthest - cameras.begin())].position();
  if (!problem_.HasParameterBlock(position))
    return;
  const Eigen::Vector3d baseline = farthest->center() - origin;
  problem_.AddResidualBlock(
      new ceres::NormalPrior(kWeight / baseline.squaredNorm() * baseline.transpose(),
                             farthest->center()),
      nullptr, position);
}

bool BundleProblem::solve() {
  // In simulations, iterations beyond 1e-7 change focal lengths by less than 1 % of their
  // standard deviations.
  ceres::Solver::Options solver = adjust::solverOptionsForPoints(
      problem_, points_, options_.rough ? 20 : 200, {options_.rough ? 1e-4 : 1e-7, 1e-14, 1e-12});
  // The scale is free, so only the damping keeps the normal equations regular: keep some of it.
  solver.max_trust_region_radius = 1e8;
  const ceres::Solver::Summary summary = adjust::minimise(solver, &problem_);
  if (!summary.IsSolutionUsable())
    throw BundleError("the adjustment failed (" + summary.message +
                      "): record the light in more places");
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (&lensOf(i) != &cameras_[i])
      std::copy_n(lensOf(i).lens(), adjust::kLensSize + adjust::kHigherDistortionSize,
                  cameras_[i].lens());
    geometry::Camera& camera = reconstruction_.cameras[i];
    camera = cameras_[i].cameraLike(camera);
  }
  return summary.termination_type == ceres::CONVERGENCE;
}

std::optional<adjust::Estimate> BundleProblem::estimate(const std::vector<std::size_t>& points) {
  std::vector<double*> blocks;
  for (std::size_t i = 0; i < (options_.one_lens ? 1 : cameras_.size()); ++i) {
    blocks.push_back(cameras_[i].lens());
    blocks.push_back(cameras_[i].higherDistortion());
  }
  for (const std::size_t point : points)
    blocks.push_back(reconstruction_.points[point]->data());
  if (!std::all_of(blocks.begin(), blocks.end(),
                   [this](const double* block) { return problem_.HasParameterBlock(block); }))
    return std::nullopt;
  return adjust::estimateOf(&problem_, blocks);
}

void adjust(Reconstruction* reconstruction, const Options& options) {
  // A camera without any inlier keeps its pose and takes no part in the triangulation.
  const int kMaximumRounds = 20;
  std::vector<bool> usable(reconstruction->cameras.size(), false);
  for (std::size_t i = 0; i < reconstruction->observations.size(); ++i) {
    if (reconstruction->inliers[i])
      usable[reconstruction->observations[i].camera] = true;
  }
  for (int round = 0; round < kMaximumRounds; ++round) {
    reconstruction->converged = BundleProblem(reconstruction, options).solve();
    if (options.rough)
      return;
    const std::vector<bool> before = reconstruction->inliers;
    const auto points = reconstruction->points;
    triangulatePoints(reconstruction, options.maximum_error, usable);
    if (reconstruction->inliers == before) {
      reconstruction->points = points;
      return;
    }
  }
  reconstruction->converged = false;
}

}  // namespace wiimote_tracker::bundle
