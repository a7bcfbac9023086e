#include "pose_trial.h"

#include "simulated_square.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Residuals = Eigen::Matrix<double, 8, 1>;
using square::Random;
using square::uniform;

constexpr double kMostRotation = 1.5 * M_PI / 180.0;
constexpr double kClear = 80.0;  // [chi^2]

Eigen::Vector3d unitVector(Random& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return Eigen::Vector3d(x, y, normal(random)).normalized();
}

/// Turned and displaced in the optical frame, about the world's origin.
geometry::Camera moved(const geometry::Camera& camera, const Vector6& step) {
  const Eigen::Isometry3d camera_from_world = camera.world_from_camera.inverse();
  Eigen::Isometry3d result;
  result.linear() = geometry::so3::exp(step.head<3>()) * camera_from_world.linear();
  result.translation() = camera_from_world.translation() + step.tail<3>();
  geometry::Camera next = camera;
  next.world_from_camera = result.inverse();
  return next;
}

/// @returns false when a corner has no pixel.
bool evaluate(const PoseTrial& trial, const geometry::Camera& camera, Residuals* residuals) {
  for (std::size_t c = 0; c < 4; ++c) {
    const auto pixel = camera.project(trial.corners[c]);
    if (!pixel)
      return false;
    residuals->segment<2>(static_cast<Eigen::Index>(2 * c)) = *pixel - trial.pixels[c];
  }
  return true;
}

std::optional<Eigen::Matrix<double, 8, 6>> jacobianOf(const PoseTrial& trial,
                                                      const geometry::Camera& camera) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 8, 6> jacobian;
  Residuals plus;
  Residuals minus;
  for (int k = 0; k < 6; ++k) {
    if (!evaluate(trial, moved(camera, kStep * Vector6::Unit(k)), &plus) ||
        !evaluate(trial, moved(camera, -kStep * Vector6::Unit(k)), &minus))
      return std::nullopt;
    jacobian.col(k) = (plus - minus) / (2.0 * kStep);
  }
  return jacobian;
}

/// @returns nothing when it cannot be evaluated at the start, or does not converge.
std::optional<square::PlanarPose> minimise(const PoseTrial& trial, geometry::Camera camera) {
  Residuals residuals;
  if (!evaluate(trial, camera, &residuals))
    return std::nullopt;
  Residuals next_residuals;
  double damping = 1e-3;
  for (int i = 0; i < 200 && damping < 1e12; ++i) {
    const auto jacobian = jacobianOf(trial, camera);
    if (!jacobian)
      return std::nullopt;
    Matrix6 information = jacobian->transpose() * *jacobian;
    const Vector6 gradient = jacobian->transpose() * residuals;
    information.diagonal() *= 1.0 + damping;
    const Vector6 step = -geometry::solveSymmetric(information, gradient);
    const geometry::Camera next = moved(camera, step);
    const bool better = evaluate(trial, next, &next_residuals) &&
                        next_residuals.squaredNorm() < residuals.squaredNorm();
    // What cannot be gained because of rounding counts as well.
    const bool converged = damping < 1.0 && -gradient.dot(step) < (better ? 1e-13 : 1e-9);
    if (better) {
      camera = next;
      residuals = next_residuals;
    }
    if (converged)
      return square::PlanarPose{camera.world_from_camera, residuals.squaredNorm()};
    damping = better ? std::max(1e-12, 0.1 * damping) : 10.0 * damping;
  }
  return std::nullopt;
}

/// The square's middle stays where it is in the image; the normal is mirrored at the line of sight.
geometry::Camera mirrored(const geometry::Camera& camera) {
  const Eigen::Isometry3d camera_from_world = camera.world_from_camera.inverse();
  const Eigen::Vector3d sight = camera_from_world.translation().normalized();
  const Eigen::Vector3d normal = camera_from_world.linear().col(2);
  const Eigen::Vector3d other = 2.0 * normal.dot(sight) * sight - normal;
  Eigen::Isometry3d result = camera_from_world;
  result.linear() = geometry::so3::between(normal, other) * camera_from_world.linear();
  geometry::Camera next = camera;
  next.world_from_camera = result.inverse();
  return next;
}

/// Any normal that shows the same side of the square, any place near the line of sight. The corners
/// stay in order: other minima, hundreds of pixels off, are of no interest.
geometry::Camera randomStart(const geometry::Camera& camera, Random& random) {
  const Eigen::Isometry3d camera_from_world = camera.world_from_camera.inverse();
  const Eigen::Vector3d normal = camera_from_world.linear().col(2);
  const Eigen::Vector3d sight = camera_from_world.translation();
  Eigen::Vector3d other = unitVector(random);
  if ((other.dot(sight) < 0.0) != (normal.dot(sight) < 0.0))
    other = -other;
  Eigen::Isometry3d start;
  start.linear() = geometry::so3::between(normal, other) * camera_from_world.linear();
  start.translation() = uniform(random, 0.7, 1.5) * sight;
  geometry::Camera result = camera;
  result.world_from_camera = start.inverse();
  return result;
}

double chiSquared(double cost) {
  return cost / (kPosePixelStddev * kPosePixelStddev);
}

/// The minimum whose attitude is nearest.
std::size_t nearest(const std::vector<square::PlanarPose>& minima, const Eigen::Isometry3d& pose) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < minima.size(); ++i) {
    const double angle = Eigen::Quaterniond(minima[i].world_from_camera.linear())
                             .angularDistance(Eigen::Quaterniond(pose.linear()));
    if (angle < least) {
      least = angle;
      best = i;
    }
  }
  return best;
}

/// Rotation from the truth to an estimate in the optical frame [rad], then displacement of the
/// square's middle in it [m].
Vector6 poseError(const PoseTrial& trial, const Eigen::Isometry3d& world_from_camera) {
  const Eigen::Isometry3d truth = trial.truth.world_from_camera.inverse();
  const Eigen::Isometry3d estimate = world_from_camera.inverse();
  Vector6 error;
  error << geometry::so3::log(estimate.linear() * truth.linear().transpose()),
      estimate.translation() - truth.translation();
  return error;
}

/// Fisher information of the pose at the truth, order and units as poseError(), by numerical
/// differentiation of the projection.
Matrix6 poseInformation(const PoseTrial& trial) {
  const Eigen::Matrix<double, 8, 6> jacobian = jacobianOf(trial, trial.truth).value();
  return jacobian.transpose() * jacobian / (kPosePixelStddev * kPosePixelStddev);
}

bool isJudged(const PoseTrial& trial, const std::vector<square::PlanarPose>& minima) {
  const Matrix6 bound = geometry::solveSymmetric(poseInformation(trial), Matrix6::Identity());
  return std::sqrt(bound.topLeftCorner<3, 3>().trace()) <= kMostRotation &&
         (minima.size() < 2 || chiSquared(minima[1].cost - minima[0].cost) >= kClear);
}

bool isWrongBranch(const PoseTrial& trial,
                   const std::vector<square::PlanarPose>& minima,
                   const Eigen::Isometry3d& world_from_camera) {
  return nearest(minima, world_from_camera) != nearest(minima, trial.truth.world_from_camera);
}

}  // namespace

PoseTrial drawPoseTrial(Random& random,
                        const geometry::Intrinsics& lens,
                        double least_tilt,
                        double most_tilt) {
  std::normal_distribution<double> noise(0.0, kPosePixelStddev);
  PoseTrial trial;
  trial.truth.intrinsics = lens;
  bool all_seen = false;
  while (!all_seen) {
    const double half = 0.5 * uniform(random, 0.5, 2.5);
    trial.corners = {Eigen::Vector3d(-half, -half, 0.0), Eigen::Vector3d(half, -half, 0.0),
                     Eigen::Vector3d(half, half, 0.0), Eigen::Vector3d(-half, half, 0.0)};
    trial.tilt = uniform(random, least_tilt, most_tilt);
    const double azimuth = uniform(random, -M_PI, M_PI);
    const double u = uniform(random, 0.0, lens.width - 1.0);
    const double v = uniform(random, 0.0, lens.height - 1.0);
    const auto sight = lens.normalizedFromPixel(Eigen::Vector2d(u, v));
    if (!sight)
      continue;
    // The square looks back along the line of sight, tilted about any axis across it.
    const Eigen::Vector3d back = -sight->homogeneous().normalized();
    const Eigen::Quaterniond facing(geometry::so3::between(Eigen::Vector3d::UnitZ(), back));
    const Eigen::Vector3d axis =
        facing * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
    Eigen::Isometry3d camera_from_world;
    camera_from_world.linear() =
        (Eigen::AngleAxisd(trial.tilt, axis) * facing *
         Eigen::AngleAxisd(uniform(random, -M_PI, M_PI), Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    camera_from_world.translation() = -uniform(random, 4.0, 8.0) * back;
    trial.truth.world_from_camera = camera_from_world.inverse();
    all_seen = std::all_of(trial.corners.begin(), trial.corners.end(),
                           [&](const Eigen::Vector3d& corner) { return trial.truth.sees(corner); });
  }
  for (std::size_t c = 0; c < 4; ++c) {
    const double u = noise(random);
    trial.pixels[c] =
        trial.truth.project(trial.corners[c]).value() + Eigen::Vector2d(u, noise(random));
  }
  return trial;
}

std::vector<square::PlanarPose> multiStartPoses(const PoseTrial& trial,
                                                int starts,
                                                Random& random) {
  std::vector<square::PlanarPose> minima;
  const auto add = [&](const geometry::Camera& start) {
    const auto found = minimise(trial, start);
    const auto is_found = [&](const square::PlanarPose& other) {
      return square::isSamePose(other.world_from_camera, found->world_from_camera, trial.corners);
    };
    if (found && std::none_of(minima.begin(), minima.end(), is_found))
      minima.push_back(*found);
  };
  add(trial.truth);
  add(mirrored(trial.truth));
  for (int i = 0; i < starts; ++i)
    add(randomStart(trial.truth, random));
  std::sort(minima.begin(), minima.end(),
            [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return minima;
}

void PoseTally::add(const PoseTrial& trial,
                    const square::PlanarPoses& found,
                    const std::vector<square::PlanarPose>& minima) {
  ++poses;
  if (found.empty() || !std::isfinite(found[0].cost)) {
    worst_excess = std::numeric_limits<double>::infinity();
    return;
  }
  worst_excess = std::max(worst_excess, chiSquared(found[0].cost - minima[0].cost));
  wrong_multi_start += isWrongBranch(trial, minima, minima[0].world_from_camera);
  if (minima.size() > 1 && chiSquared(minima[1].cost - minima[0].cost) < kClear)
    missed += found.size() < 2 || chiSquared(found[1].cost - minima[1].cost) > 1e-6;
  const Eigen::Isometry3d& pose = found[0].world_from_camera;
  wrong += isWrongBranch(trial, minima, pose);
  if (!isJudged(trial, minima))
    return;
  ++judged;
  const Vector6 error = poseError(trial, pose);
  nees += error.dot(poseInformation(trial) * error);
}

double PoseTally::whitened() const {
  return std::sqrt(nees / (6.0 * judged));
}

}  // namespace wiimote_tracker
