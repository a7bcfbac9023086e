#include "body/pose_uncertainty.h"

#include "pixel_update.h"
#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cstddef>

namespace wiimote_tracker::body {
namespace {

using geometry::kParameters;

constexpr std::size_t kMaximumCameras = 16;  // more are left out

struct Sums {
  PoseCovariance information = PoseCovariance::Zero();  // J^T J of all cameras
  std::array<std::size_t, kMaximumCameras> cameras;
  std::array<Eigen::Matrix<double, 6, kParameters>, kMaximumCameras> by_parameters;  // their J^T A
  std::size_t count = 0;
};

enum class Pixels { kSeen, kInView };

bool isSeen(const LedEstimate& led, std::size_t camera) {
  return std::find(led.cameras.begin(), led.cameras.end(), camera) != led.cameras.end();
}

Sums sumsOf(const geometry::Rig& rig,
            const Constellation& constellation,
            const BodyEstimate& estimate,
            Pixels pixels) {
  Sums sums;
  for (std::size_t c = 0; c < rig.cameras.size() && sums.count < kMaximumCameras; ++c) {
    Eigen::Matrix<double, 6, kParameters>& by_parameters = sums.by_parameters[sums.count];
    by_parameters.setZero();
    sums.cameras[sums.count] = c;
    bool has_pixels = false;
    for (std::size_t i = 0; i < constellation.leds.size(); ++i) {
      const LedEstimate& led = estimate.leds[i];
      if (pixels == Pixels::kSeen && !isSeen(led, c))
        continue;
      auto projection = geometry::rayProjection(rig, c, led.position);
      if (!projection || (pixels == Pixels::kInView &&
                          !rig.cameras[c].camera.intrinsics.isInImage(projection->pixel)))
        continue;
      has_pixels = true;
      const Eigen::Vector3d arm = estimate.world_from_body.linear() * constellation.leds[i];
      projection->by_parameters.col(geometry::kTimeOffset).noalias() =
          projection->by_point * (estimate.velocity + estimate.angular_velocity.cross(arm));
      const Eigen::Matrix<double, 2, 6> by_pose = projection->by_point * pointByPose(arm);
      sums.information.noalias() += by_pose.transpose() * by_pose;
      by_parameters.noalias() += by_pose.transpose() * projection->by_parameters;
    }
    sums.count += has_pixels ? 1 : 0;
  }
  return sums;
}

std::optional<PoseCovariance> covarianceOf(const Eigen::MatrixXd& rig_covariance,
                                           const Sums& sums) {
  // One camera and four LEDs 0.1 m apart have about 1e-6.
  constexpr double kSingular = 1e-9;
  const Eigen::LLT<PoseCovariance> factor(sums.information);
  if (sums.count == 0 || factor.info() != Eigen::Success || !(factor.rcond() > kSingular))
    return std::nullopt;
  const PoseCovariance sum = geometry::propagatedErrors(rig_covariance, sums.by_parameters.data(),
                                                        sums.cameras.data(), sums.count);
  const PoseCovariance half = factor.solve(sum);
  const PoseCovariance covariance = factor.solve(half.transpose());
  if (!covariance.allFinite())
    return std::nullopt;
  return PoseCovariance(0.5 * (covariance + covariance.transpose()));
}

}  // namespace

std::optional<PoseCovariance> calibrationCovariance(const geometry::Rig& rig,
                                                    const Constellation& constellation,
                                                    const BodyEstimate& estimate) {
  if (!geometry::hasCovariance(rig))
    return std::nullopt;
  const auto seen =
      covarianceOf(rig.covariance, sumsOf(rig, constellation, estimate, Pixels::kSeen));
  return seen ? seen
              : covarianceOf(rig.covariance, sumsOf(rig, constellation, estimate, Pixels::kInView));
}

}  // namespace wiimote_tracker::body
