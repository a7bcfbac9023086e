// A solver of its own: OpenCV's iterative one is as accurate but takes eight times as long
// (doc/square.md) and gives one of the two poses only; and this one does not allocate.
#include "square/planar_pose.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace wiimote_tracker::square {

namespace {

constexpr double kSameAngle = 3.5e-4;   // [rad]
constexpr double kSameDistance = 2e-4;  // [1]

using Pixels = std::array<Eigen::Vector2d, 4>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Where the plane is, in the optical frame; the plane's origin is the middle of the corners.
struct PlaneInCamera {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
};

/// Whether three of the points, of third coordinate 1, are on one line or two in one place.
bool isDegenerate(const std::array<Eigen::Vector3d, 4>& points) {
  double extent = 0.0;
  for (std::size_t i = 1; i < 4; ++i)
    extent = std::max(extent, (points[i] - points[0]).squaredNorm());
  for (std::size_t i = 0; i < 4; ++i) {
    const double area = points[i].dot(points[(i + 1) % 4].cross(points[(i + 2) % 4]));
    if (!(std::abs(area) > 1e-9 * extent))
      return true;
  }
  return false;
}

/// The matrix that takes the unit vectors and (1, 1, 1) to these points, each up to scale. The
/// factor that would divide by the triangle's area is left out.
Eigen::Matrix3d fromProjectiveBasis(const std::array<Eigen::Vector3d, 4>& points) {
  Eigen::Matrix3d basis;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& next = points[static_cast<std::size_t>((i + 1) % 3)];
    const Eigen::Vector3d& after = points[static_cast<std::size_t>((i + 2) % 3)];
    // Cramer's rule for the weights that make the columns add up to the fourth point.
    basis.col(i) = points[static_cast<std::size_t>(i)] * points[3].dot(next.cross(after));
  }
  return basis;
}

/// The two poses that agree with the homography in the middle of the corners to first order.
bool startPoses(const geometry::Intrinsics& intrinsics,
                const Pixels& pixels,
                const Corners& in_plane,
                std::array<PlaneInCamera, 2>* poses) {
  std::array<Eigen::Vector3d, 4> normalized;
  std::array<Eigen::Vector3d, 4> plane;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto undistorted = intrinsics.normalizedFromPixel(pixels[c]);
    if (!undistorted)
      return false;
    normalized[c] = undistorted->homogeneous();
    plane[c] = Eigen::Vector3d(in_plane[c].x(), in_plane[c].y(), 1.0);
  }
  if (isDegenerate(normalized) || isDegenerate(plane))
    return false;
  Eigen::Matrix3d homography =
      fromProjectiveBasis(normalized) * fromProjectiveBasis(plane).inverse();
  homography /= homography(2, 2);
  if (!homography.allFinite())
    return false;

  // Derivative of the image by the plane, at the plane's origin, whose image is v.
  const Eigen::Vector3d v = homography.col(2);
  const Eigen::Matrix2d by_plane =
      homography.topLeftCorner<2, 2>() - v.head<2>() * homography.bottomLeftCorner<1, 2>();
  // The same seen by a camera turned so that it looks straight at the plane's origin: there it is
  // the upper left part of the rotation over the distance.
  const double length = v.norm();
  const Eigen::Matrix3d camera_from_sight =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), v).toRotationMatrix();
  const Eigen::Matrix2d seen =
      camera_from_sight.topLeftCorner<2, 2>().transpose() * by_plane / length;
  const Eigen::Matrix2d squared = seen.transpose() * seen;
  const double half_trace = 0.5 * squared.trace();
  const double largest =
      half_trace + std::hypot(0.5 * (squared(0, 0) - squared(1, 1)), squared(0, 1));
  const double distance = 1.0 / std::sqrt(largest);
  if (!(distance > 0.0) || !std::isfinite(distance))
    return false;
  // The columns of a rotation have length 1: what is missing is along the line of sight, towards
  // the camera or away from it.
  const Eigen::Matrix2d upper = distance * seen;
  const Eigen::Matrix2d missing = Eigen::Matrix2d::Identity() - upper.transpose() * upper;
  const Eigen::Vector2d along(
      std::sqrt(std::max(0.0, missing(0, 0))),
      std::copysign(std::sqrt(std::max(0.0, missing(1, 1))), missing(0, 1)));
  for (std::size_t i = 0; i < 2; ++i) {
    const double sign = i == 0 ? 1.0 : -1.0;
    Eigen::Matrix3d rotation;
    rotation.col(0) << upper.col(0), sign * along.x();
    rotation.col(1) << upper.col(1), sign * along.y();
    rotation.col(2) = rotation.col(0).cross(rotation.col(1)).normalized();
    rotation.col(0).normalize();
    rotation.col(1) = rotation.col(2).cross(rotation.col(0));
    (*poses)[i].rotation.noalias() = camera_from_sight * rotation;
    (*poses)[i].origin = distance * v / length;
    if (!(*poses)[i].rotation.allFinite())
      return false;
  }
  return true;
}

/// Half the sum of the squared reprojection errors, around one pose. Its parameters are a small
/// rotation about the plane's origin, then a displacement, both in the optical frame.
struct Expansion {
  double cost;  // the whole sum [px^2]
  Vector6 gradient;
  Matrix6 second_derivative;  // without that of the residuals
  bool has_curvature;
  Matrix6 curvature;  // what that leaves out, for a lens without distortion
};

class Reprojection {
 public:
  Reprojection(const geometry::Intrinsics& intrinsics,
               const Pixels& pixels,
               const Corners& in_plane)
      : intrinsics_(intrinsics), pixels_(pixels), in_plane_(in_plane) {}

  /// Nothing when a corner is not in front of the camera.
  std::optional<Expansion> at(const PlaneInCamera& pose, bool with_curvature) const {
    Eigen::Matrix<double, 8, 6> jacobian;
    Eigen::Matrix<double, 8, 1> residuals;
    Corners arms;
    std::array<double, 4> depths;
    for (std::size_t c = 0; c < 4; ++c) {
      arms[c] = pose.rotation.leftCols<2>() * in_plane_[c].head<2>();
      const Eigen::Vector3d point = arms[c] + pose.origin;
      depths[c] = point.z();
      if (!(point.z() > 1e-6))
        return std::nullopt;
      const Eigen::Vector2d normalized = point.head<2>() / point.z();
      const auto row = static_cast<Eigen::Index>(2 * c);
      Eigen::Matrix2d by_normalized;
      residuals.segment<2>(row) =
          intrinsics_.pixelFromNormalized(normalized, &by_normalized) - pixels_[c];
      by_normalized /= point.z();
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector3d by_point(by_normalized(axis, 0), by_normalized(axis, 1),
                                       -by_normalized.row(axis).dot(normalized));
        jacobian.row(row + axis) << arms[c].cross(by_point).transpose(), by_point.transpose();
      }
    }
    Expansion sum;
    sum.cost = residuals.squaredNorm();
    sum.gradient.noalias() = jacobian.transpose() * residuals;
    sum.second_derivative.noalias() = jacobian.transpose() * jacobian;
    sum.has_curvature = with_curvature;
    if (!with_curvature)
      return sum;

    // Differentiating normalized * depth = point twice: what the depth, and what the rotation of
    // the arm, add.
    sum.curvature.setZero();
    for (std::size_t c = 0; c < 4; ++c) {
      const auto row = static_cast<Eigen::Index>(2 * c);
      const Vector6 gradient = jacobian.middleRows<2>(row).transpose() * residuals.segment<2>(row);
      Vector6 depth;
      depth << arms[c].y(), -arms[c].x(), 0.0, 0.0, 0.0, 1.0;
      depth /= depths[c];
      sum.curvature.noalias() -= gradient * depth.transpose();
      sum.curvature.noalias() -= depth * gradient.transpose();
      const Eigen::Vector3d pull = gradient.tail<3>();
      auto turn = sum.curvature.topLeftCorner<3, 3>();
      turn += 0.5 * (pull * arms[c].transpose() + arms[c] * pull.transpose());
      turn.diagonal().array() -= pull.dot(arms[c]);
    }
    return sum;
  }

  bool isImagedByLens(const PlaneInCamera& pose) const {
    return std::all_of(in_plane_.begin(), in_plane_.end(), [&](const Eigen::Vector3d& corner) {
      const Eigen::Vector3d point = pose.rotation * corner + pose.origin;
      return intrinsics_.isBeforeFold(point.head<2>() / point.z());
    });
  }

 private:
  const geometry::Intrinsics& intrinsics_;
  const Pixels& pixels_;
  const Corners& in_plane_;
};

PlaneInCamera moved(const PlaneInCamera& pose, const Vector6& step) {
  return {geometry::so3::exp(step.head<3>()) * pose.rotation, pose.origin + step.tail<3>()};
}

/// Newton's step where the cost is convex and its curvature known, else Gauss and Newton's.
std::optional<Vector6> descend(const Expansion& expansion, double damping) {
  Matrix6 damped = expansion.second_derivative;
  damped.diagonal() *= 1.0 + damping;
  Eigen::LLT<Matrix6> factors;
  if (expansion.has_curvature)
    factors.compute(damped + expansion.curvature);
  if (!expansion.has_curvature || factors.info() != Eigen::Success)
    factors.compute(damped);
  if (factors.info() != Eigen::Success)
    return std::nullopt;
  return -factors.solve(expansion.gradient);
}

/// Least reprojection error from here, damped only where a step does not gain (Levenberg and
/// Marquardt).
/// @returns its sum of squares [px^2]; nothing when the start has a corner behind the camera, or
/// leads nowhere.
std::optional<double> refine(const Reprojection& reprojection, PlaneInCamera* pose) {
  // Gauss and Newton's steps are the cheaper ones and mostly suffice. Near the view from straight
  // above, where the two branches meet, they converge slowly.
  constexpr int kGaussNewtonSteps = 3;
  constexpr int kMaximumSteps = 200;
  constexpr double kNegligible = 1e-13;  // gain [px^2], and relative to the cost
  constexpr double kLeastDamping = 1e-4;

  std::optional<Expansion> here = reprojection.at(*pose, false);
  double damping = 0.0;
  for (int i = 0; here && i < kMaximumSteps; ++i) {
    const std::optional<Vector6> step = descend(*here, damping);
    bool better = false;
    if (step) {
      const bool converged =
          damping < 1.0 && -here->gradient.dot(*step) < kNegligible * (1.0 + here->cost);
      const PlaneInCamera next = moved(*pose, *step);
      const std::optional<Expansion> there = reprojection.at(next, i + 1 >= kGaussNewtonSteps);
      better = there && there->cost < here->cost;
      if (better) {
        *pose = next;
        here = there;
      }
      if (converged)
        return here->cost;
    }
    if (better)
      damping = damping > kLeastDamping ? 0.1 * damping : 0.0;
    else
      damping = std::max(kLeastDamping, 10.0 * damping);
  }
  return std::nullopt;
}

}  // namespace

void PlanarPoses::add(const PlanarPose& pose) {
  PlanarPose carried = pose;
  for (std::size_t i = 0; i < size_; ++i) {
    if (carried.cost < poses_[i].cost)
      std::swap(carried, poses_[i]);
  }
  if (size_ < poses_.size())
    poses_[size_++] = carried;
}

PlanarPoses planarPoses(const geometry::Intrinsics& intrinsics,
                        const Pixels& pixels,
                        const Corners& corners) {
  const Eigen::Vector3d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  Corners in_plane;
  for (std::size_t c = 0; c < 4; ++c)
    in_plane[c] = corners[c] - middle;
  PlanarPoses poses;
  std::array<PlaneInCamera, 2> starts;
  if (!startPoses(intrinsics, pixels, in_plane, &starts))
    return poses;
  const Reprojection reprojection(intrinsics, pixels, in_plane);
  const auto add = [&](PlaneInCamera pose) {
    const std::optional<double> cost = refine(reprojection, &pose);
    if (!cost || !std::isfinite(*cost) || !reprojection.isImagedByLens(pose))
      return;
    PlanarPose found;
    found.world_from_camera.linear() = pose.rotation.transpose();
    found.world_from_camera.translation() = middle - pose.rotation.transpose() * pose.origin;
    found.cost = *cost;
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const PlanarPose& other) {
      return isSamePose(other.world_from_camera, found.world_from_camera, corners);
    });
    if (!known)
      poses.add(found);
  };
  add(starts[0]);
  add(starts[1]);
  return poses;
}

bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Corners& corners) {
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  const double distance = (a.translation() - 0.5 * (corners[0] + corners[2])).norm();
  return std::abs(turn.angle()) < kSameAngle &&
         (a.translation() - b.translation()).norm() < kSameDistance * distance;
}

}  // namespace wiimote_tracker::square
