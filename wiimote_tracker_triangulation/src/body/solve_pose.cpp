// solvePose() has Levenberg-Marquardt for six parameters written out, because it runs for every
// image and must not allocate, unlike the solvers of Eigen and Ceres.
#include "body/solve_pose.h"

#include "body/align.h"
#include "pixel_update.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
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

/// Nothing when the information does not determine the pose.
std::optional<PoseCovariance> inverseOf(const PoseCovariance& information) {
  const Eigen::LLT<PoseCovariance> factor(information);
  // A metre moves a spot ten times as far as a radian (arm 0.1 m): scaling is not needed.
  if (factor.info() != Eigen::Success || factor.rcond() < 1e-12)
    return std::nullopt;
  return factor.solve(PoseCovariance::Identity());
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
  const auto covariance = inverseOf(normal->information);
  if (!covariance)
    return std::nullopt;
  SolvedPose solved;
  solved.world_from_body = pose;
  solved.covariance = pixel_stddev * pixel_stddev * *covariance;
  solved.reprojection_error = std::sqrt(normal->cost / count);
  return solved;
}

std::optional<BodyPose> poseFromLabels(const Constellation& constellation,
                                       const std::vector<LabelledPoint>& points) {
  // Greatest mean squared residual per coordinate [variances]: refuses wrong labels.
  constexpr double kWorst = 9.0;
  constexpr double kMotion = 0.002;  // of the LEDs between the images of the points [m]
  std::array<PointPair, kMaximumLeds> pairs;
  std::array<Eigen::Matrix3d, kMaximumLeds> information;
  std::size_t count = 0;
  for (std::size_t led = 0; led < constellation.leds.size(); ++led) {
    const auto point =
        std::find_if(points.begin(), points.end(), [&](const LabelledPoint& candidate) {
          return candidate.label == constellation.labels[led];
        });
    if (point == points.end())
      continue;
    const Eigen::Matrix3d covariance =
        point->covariance + kMotion * kMotion * Eigen::Matrix3d::Identity();
    information[count] = covariance.inverse();
    pairs[count++] = {constellation.leds[led], point->position, 3.0 / covariance.trace()};
  }
  if (count < 3)
    return std::nullopt;
  const Alignment alignment = align(pairs.data(), count);
  if (alignment.cost > kWorst * 3 * count)
    return std::nullopt;
  PoseCovariance normal = PoseCovariance::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix<double, 3, 6> jacobian =
        pointByPose(alignment.world_from_body.linear() * pairs[i].in_body);
    normal += jacobian.transpose() * information[i] * jacobian;
  }
  const auto covariance = inverseOf(normal);
  return covariance ? std::make_optional(BodyPose{alignment.world_from_body, *covariance})
                    : std::nullopt;
}

}  // namespace wiimote_tracker::body
