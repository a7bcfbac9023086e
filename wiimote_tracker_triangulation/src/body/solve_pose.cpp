// Levenberg-Marquardt for six parameters, written out because it runs for every image and must not
// allocate, unlike the solvers of Eigen and Ceres.
#include "body/solve_pose.h"

#include "pixel_update.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::body {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// With the Jacobian J of the pixels and their residuals r: J^T J step = J^T r.
struct NormalEquations {
  PoseCovariance information = PoseCovariance::Zero();  // J^T J
  Vector6 right = Vector6::Zero();                      // J^T r
  double cost = 0.0;                                    // r^T r [px^2]
};

std::optional<NormalEquations> normalAt(const LedObservation* observations,
                                        std::size_t count,
                                        const Eigen::Isometry3d& pose) {
  NormalEquations normal;
  for (std::size_t i = 0; i < count; ++i) {
    const LedObservation& observation = observations[i];
    const Eigen::Vector3d arm = pose.linear() * observation.led;
    Eigen::Matrix<double, 2, 3> by_point;
    const auto pixel = observation.camera->project(pose.translation() + arm, &by_point);
    if (!pixel)
      return std::nullopt;
    const Eigen::Matrix<double, 2, 6> jacobian = by_point * pointByPose(arm);
    const Eigen::Vector2d residual = observation.pixel - *pixel;
    normal.information.noalias() += jacobian.transpose() * jacobian;
    normal.right.noalias() += jacobian.transpose() * residual;
    normal.cost += residual.squaredNorm();
  }
  return normal;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vector6& step) {
  Eigen::Isometry3d result = pose;
  result.linear() = geometry::so3::exp(step.tail<3>()) * pose.linear();
  result.translation() += step.head<3>();
  return result;
}

}  // namespace

std::optional<SolvedPose> solvePose(const LedObservation* observations,
                                    std::size_t count,
                                    const Eigen::Isometry3d& start,
                                    double pixel_stddev) {
  if (count < 3)
    return std::nullopt;
  constexpr int kMaximumSteps = 30;
  Eigen::Isometry3d pose = start;
  std::optional<NormalEquations> normal = normalAt(observations, count, pose);
  double damping = 1e-6;
  bool converged = false;
  for (int i = 0; normal && !converged && i < kMaximumSteps; ++i) {
    PoseCovariance damped = normal->information;
    damped.diagonal() *= 1.0 + damping;
    const Vector6 step = damped.ldlt().solve(normal->right);
    if (!step.allFinite())
      return std::nullopt;
    const Eigen::Isometry3d next = moved(pose, step);
    const std::optional<NormalEquations> there = normalAt(observations, count, next);
    if (there && there->cost <= normal->cost) {
      // The step was below a hundredth of the standard deviation.
      converged = step.dot(normal->right) < 1e-4 * pixel_stddev * pixel_stddev;
      pose = next;
      normal = there;
      damping = std::max(0.1 * damping, 1e-9);
    } else {
      // At the minimum only rounding prevents a decrease.
      converged = step.dot(normal->right) < 1e-9 * (normal->cost + 1e-12);
      damping = std::max(10.0 * damping, 1e-3);
    }
  }
  if (!normal || !converged)
    return std::nullopt;
  const Eigen::LLT<PoseCovariance> factor(normal->information);
  // A metre moves a spot ten times as far as a radian (arm 0.1 m): scaling is not needed.
  if (factor.info() != Eigen::Success || factor.rcond() < 1e-12)
    return std::nullopt;
  SolvedPose solved;
  solved.world_from_body = pose;
  solved.covariance = pixel_stddev * pixel_stddev * factor.solve(PoseCovariance::Identity());
  solved.reprojection_error = std::sqrt(normal->cost / count);
  return solved;
}

}  // namespace wiimote_tracker::body
