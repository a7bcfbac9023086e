#include "continuous/adjustment.h"

#include "adjust/camera_blocks.h"
#include "adjust/covariance.h"
#include "adjust/joint_prior.h"
#include "adjust/moving_pixel.h"
#include "adjust/solver.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <ceres/problem.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace wiimote_tracker::continuous {

namespace {

using adjust::CameraBlocks;
using geometry::firstParameter;
using geometry::kDistortion;
using geometry::kTimeOffset;

// Gates of the keyframes: of the first rounds, which a new clock needs, [px]; of the final rounds
// [standard deviations].
constexpr double kWideGates[] = {30.0, 10.0, 5.0};
constexpr double kGate = 3.0;
constexpr int kFinalRounds = 2;
// In the first rounds: scale of the robust loss, and standard deviation of a spot [px].
constexpr double kLoss = 3.0;
constexpr double kPixel = 0.5;
constexpr int kSteps = 10;            // Of the solver, in each round.
constexpr double kLeastExtent = 0.1;  // Of the keyframes, standard deviation [m].
// Least variance of a parameter: one that was held has none.
constexpr double kHeldVariance = 1e-12;

/// The rig with what cameras and clocks may have done since.
geometry::Rig priorOf(const geometry::Rig& rig, const KeyframeSource& source, double time) {
  geometry::Rig prior = withClockPrior(withDrift(rig, time), source);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    prior.covariance.diagonal().segment<kTimeOffset>(firstParameter(i)).array() += kHeldVariance;
  return prior;
}

/// Sets to zero what the prior says of coefficients that a lens does not have: a rig must not.
Eigen::MatrixXd ofExistingCoefficients(const geometry::Rig& rig, Eigen::MatrixXd covariance) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto coefficients = static_cast<Eigen::Index>(
        geometry::coefficientCount(rig.cameras[i].camera.intrinsics.distortion_model));
    for (Eigen::Index k = kDistortion + coefficients; k < kTimeOffset; ++k) {
      covariance.row(firstParameter(i) + k).setZero();
      covariance.col(firstParameter(i) + k).setZero();
    }
  }
  return covariance;
}

/// Whether there are enough, and they do not lie together.
bool areSpread(const std::vector<Keyframe>& keyframes) {
  std::vector<Eigen::Vector3d> points;
  for (const Keyframe& keyframe : keyframes)
    points.push_back(keyframe.point);
  return points.size() >= kLeastKeyframes && geometry::spreadOf(points).norm() > kLeastExtent;
}

/// Adds the keyframes around the present values of the cameras' blocks. @returns their points.
std::vector<double*> addKeyframes(double pixel_stddev,
                                  double loss_scale,
                                  std::vector<Keyframe>* keyframes,
                                  std::vector<CameraBlocks>* cameras,
                                  ceres::Problem* problem) {
  std::vector<double*> points;
  for (Keyframe& keyframe : *keyframes) {
    points.push_back(keyframe.point.data());
    for (const View& view : keyframe.views) {
      CameraBlocks& camera = (*cameras)[view.camera];
      const adjust::InterpolatedPixelError error{
          adjust::PixelError(camera, view.pixel, pixel_stddev), view.velocity,
          *camera.timeOffset()};
      camera.addTo(problem, error.cost(), adjust::lossOf(loss_scale), camera.timeOffset(),
                   points.back());
    }
  }
  return points;
}

/// @param blocks of all cameras, as in the rig's covariance.
void addPrior(const geometry::Rig& prior,
              const std::vector<double*>& blocks,
              ceres::Problem* problem) {
  std::vector<double> mean;
  std::vector<std::int32_t> sizes;
  for (const geometry::RigCamera& camera : prior.cameras) {
    const CameraBlocks start(camera.camera, camera.time_offset);
    mean.insert(mean.end(), start.values.begin(), start.values.end());
    sizes.insert(sizes.end(), CameraBlocks::kSizes.begin(), CameraBlocks::kSizes.end());
  }
  problem->AddResidualBlock(
      new adjust::JointPrior(Eigen::Map<Eigen::VectorXd>(mean.data(), prior.covariance.rows()),
                             prior.covariance, sizes),
      nullptr, blocks);
}

/// Alternates between keyframes and solutions.
class Adjustment {
 public:
  Adjustment(const geometry::Rig& prior, const KeyframeSource& source)
      : prior_(prior), source_(source), rig_(prior) {
    for (const geometry::RigCamera& camera : prior.cameras)
      cameras_.emplace_back(camera.camera, camera.time_offset);
  }

  std::optional<geometry::Rig> solve() {
    for (const double gate : kWideGates) {
      if (!round(gate, kPixel, kLoss / kPixel))
        return std::nullopt;
    }
    for (int i = 0; i < kFinalRounds; ++i) {
      const double stddev = rmsResidual(source_.keyframes(rig_, kWideGates[2]));
      // The gate is for both axes together.
      if (!round(std::sqrt(2.0) * kGate * stddev, stddev, std::numeric_limits<double>::infinity()))
        return std::nullopt;
    }
    return rig_;
  }

 private:
  /// @returns whether there was enough to solve.
  bool round(double gate, double pixel_stddev, double loss_scale) {
    std::vector<Keyframe> keyframes = source_.keyframes(rig_, gate);
    if (!areSpread(keyframes))
      return false;
    ceres::Problem problem;
    const std::vector<double*> blocks = adjust::blocksOf(&cameras_);
    const std::vector<double*> points =
        addKeyframes(pixel_stddev, loss_scale, &keyframes, &cameras_, &problem);
    addPrior(prior_, blocks, &problem);
    const ceres::Solver::Options options = adjust::solverOptionsForPoints(problem, points, kSteps);
    if (!adjust::minimise(options, &problem).IsSolutionUsable())
      return false;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      rig_.cameras[i].camera = cameras_[i].cameraLike(rig_.cameras[i].camera);
      rig_.cameras[i].time_offset = *cameras_[i].timeOffset();
    }
    if (std::isfinite(loss_scale))
      return true;
    const auto covariance = adjust::covarianceOf(&problem, blocks);
    if (covariance)
      rig_.covariance = ofExistingCoefficients(rig_, *covariance);
    return covariance.has_value();
  }

  const geometry::Rig& prior_;
  const KeyframeSource& source_;
  geometry::Rig rig_;
  std::vector<CameraBlocks> cameras_;
};

}  // namespace

std::optional<geometry::Rig> adjustRig(const geometry::Rig& rig,
                                       const std::vector<capture::Image>& images) {
  if (!geometry::hasCovariance(rig) || rig.ray_model != geometry::RayModel::kCalibrated ||
      images.empty())
    return std::nullopt;
  const KeyframeSource source(rig, images);
  const geometry::Rig prior = priorOf(rig, source, images.back().stamp);
  auto adjusted = Adjustment(prior, source).solve();
  if (adjusted)
    holdTime(rig, source, &*adjusted);
  return adjusted;
}

}  // namespace wiimote_tracker::continuous
