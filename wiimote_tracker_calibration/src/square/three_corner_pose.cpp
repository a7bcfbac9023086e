#include "square/three_corner_pose.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::square {

namespace {

// Of the distances between the points, relative: farther off than this is no start.
constexpr double kAcceptable = 1e-2;

/// Coefficients by rising power.
using Polynomial = Eigen::Matrix<double, 5, 1>;

Polynomial product(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Polynomial result = Polynomial::Zero();
  for (int i = 0; i < 3; ++i)
    result.segment<3>(i) += a[i] * b;
  return result;
}

/// Real parts of all roots: two that meet may leave the real axis by an error of the pixels.
std::vector<double> realPartsOfRoots(const Polynomial& polynomial) {
  Eigen::Index degree = 4;
  const double least = 1e-12 * polynomial.cwiseAbs().maxCoeff();
  while (degree > 0 && std::abs(polynomial[degree]) <= least)
    --degree;
  if (degree == 0)
    return {};
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  companion.bottomLeftCorner(degree - 1, degree - 1).setIdentity();
  companion.col(degree - 1) = -polynomial.head(degree) / polynomial[degree];
  const Eigen::VectorXd roots = companion.eigenvalues().real();
  return {roots.data(), roots.data() + roots.size()};
}

/// The law of cosines in the three triangles with the camera.
struct Triangles {
  Eigen::Vector3d squared_sides;  // between points 1 2, 2 0, 0 1 [m^2]
  Eigen::Vector3d cosines;        // between their directions

  Eigen::Vector3d residuals(const Eigen::Vector3d& distances) const {
    Eigen::Vector3d result;
    for (int i = 0; i < 3; ++i) {
      const double a = distances[(i + 1) % 3];
      const double b = distances[(i + 2) % 3];
      result[i] = a * a + b * b - 2.0 * a * b * cosines[i] - squared_sides[i];
    }
    return result;
  }

  Eigen::Matrix3d jacobian(const Eigen::Vector3d& distances) const {
    Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3;
      const int b = (i + 2) % 3;
      result(i, a) = 2.0 * (distances[a] - distances[b] * cosines[i]);
      result(i, b) = 2.0 * (distances[b] - distances[a] * cosines[i]);
    }
    return result;
  }
};

/// Candidates for the three distances [m]: with v = d2 / d0, the other ratio u = d1 / d0 follows
/// from the difference of two of the laws, and v from a quartic.
std::vector<Eigen::Vector3d> distances(const Triangles& triangles) {
  const double k =
      (triangles.squared_sides[0] - triangles.squared_sides[2]) / triangles.squared_sides[1];
  const double ratio = triangles.squared_sides[2] / triangles.squared_sides[1];
  const double alpha = triangles.cosines[0];
  const double beta = triangles.cosines[1];
  const double gamma = triangles.cosines[2];
  // u = numerator / denominator; side: the squared side 2 0 over d0^2.
  const Eigen::Vector3d side(1.0, -2.0 * beta, 1.0);
  const Eigen::Vector3d numerator = Eigen::Vector3d(-1.0, 0.0, 1.0) - k * side;
  const Eigen::Vector3d denominator(-2.0 * gamma, 2.0 * alpha, 0.0);
  // 1 + u^2 - 2 u gamma = ratio * side, times denominator^2, which is of first degree squared.
  const Eigen::Vector3d squared = product(denominator, denominator).head<3>();
  const Polynomial quartic = product(squared, Eigen::Vector3d(1.0, 0.0, 0.0) - ratio * side) +
                             product(numerator, numerator) -
                             2.0 * gamma * product(numerator, denominator);
  std::vector<Eigen::Vector3d> result;
  for (const double v : realPartsOfRoots(quartic)) {
    const double side_by_d0 = 1.0 + v * (v - 2.0 * beta);
    if (!(v > 0.0) || !(side_by_d0 > 0.0))
      continue;
    const double d0 = std::sqrt(triangles.squared_sides[1] / side_by_d0);
    // Both u that the last law allows, because the quotient may be 0 / 0.
    const double root = std::sqrt(std::max(0.0, gamma * gamma - 1.0 + ratio * side_by_d0));
    for (const double u : {gamma - root, gamma + root})
      result.emplace_back(d0, u * d0, v * d0);
  }
  return result;
}

/// Newton's method on the three laws; a step only where it gains.
/// @returns false when it ends with a triangle that is not the one asked for.
bool polish(const Triangles& triangles, Eigen::Vector3d* distances) {
  Eigen::Vector3d residuals = triangles.residuals(*distances);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d step = -triangles.jacobian(*distances).inverse() * residuals;
    const Eigen::Vector3d next = triangles.residuals(*distances + step);
    if (!(next.squaredNorm() < residuals.squaredNorm()))
      break;
    *distances += step;
    residuals = next;
  }
  return distances->minCoeff() > 0.0 &&
         residuals.cwiseAbs().maxCoeff() < kAcceptable * triangles.squared_sides.minCoeff();
}

/// Axes of a triangle: along its first side, across it in the plane, normal.
Eigen::Matrix3d axes(const std::array<Eigen::Vector3d, 3>& points) {
  Eigen::Matrix3d result;
  result.col(0) = (points[1] - points[0]).normalized();
  result.col(2) = (points[1] - points[0]).cross(points[2] - points[0]).normalized();
  result.col(1) = result.col(2).cross(result.col(0));
  return result;
}

}  // namespace

std::vector<Eigen::Isometry3d> threeCornerPoses(const std::array<Eigen::Vector3d, 3>& points,
                                                const std::array<Eigen::Vector3d, 3>& directions) {
  std::array<Eigen::Vector3d, 3> sights;
  for (std::size_t i = 0; i < 3; ++i)
    sights[i] = directions[i].normalized();
  Triangles triangles;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t a = (i + 1) % 3;
    const std::size_t b = (i + 2) % 3;
    triangles.squared_sides[static_cast<Eigen::Index>(i)] = (points[a] - points[b]).squaredNorm();
    triangles.cosines[static_cast<Eigen::Index>(i)] = sights[a].dot(sights[b]);
  }

  std::vector<Eigen::Vector3d> found;
  std::vector<Eigen::Isometry3d> poses;
  for (Eigen::Vector3d candidate : distances(triangles)) {
    if (!polish(triangles, &candidate))
      continue;
    const bool known = std::any_of(found.begin(), found.end(), [&](const Eigen::Vector3d& other) {
      return (candidate - other).norm() < 1e-6 * candidate.norm();
    });
    if (known)
      continue;
    found.push_back(candidate);
    std::array<Eigen::Vector3d, 3> in_camera;
    for (std::size_t i = 0; i < 3; ++i)
      in_camera[i] = candidate[static_cast<Eigen::Index>(i)] * sights[i];
    Eigen::Isometry3d world_from_camera;
    world_from_camera.linear() = axes(points) * axes(in_camera).transpose();
    // The middle, so that a triangle that is not quite the one asked for is off alike at all three.
    world_from_camera.translation() =
        (points[0] + points[1] + points[2] -
         world_from_camera.linear() * (in_camera[0] + in_camera[1] + in_camera[2])) /
        3.0;
    if (world_from_camera.matrix().allFinite())
      poses.push_back(world_from_camera);
  }
  return poses;
}

}  // namespace wiimote_tracker::square
