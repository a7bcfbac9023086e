#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::geometry {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

struct Sight {
  Ray ray;
  Matrix32 direction_by_pixel;
  Matrix32 position_by_pixel;  // of the linear methods
};

/// As many as there are observations; on the stack as long as they are few.
class Sights {
 public:
  explicit Sights(std::size_t size) : size_(size) {
    if (size > inline_.size())
      heap_.resize(size);
  }
  Sight* begin() { return heap_.empty() ? inline_.data() : heap_.data(); }
  Sight* end() { return begin() + size_; }

 private:
  std::size_t size_;
  std::array<Sight, 16> inline_;
  std::vector<Sight> heap_;
};

bool isParallel(const Ray& a, const Ray& b, double minimum_angle) {
  // The sine, not the cosine: exact for small angles. Opposite directions are parallel, too.
  return !(a.direction.cross(b.direction).norm() >= std::sin(minimum_angle));
}

bool haveAngle(Sights& sights, double minimum_angle) {
  for (const Sight& a : sights) {
    for (const Sight* b = &a + 1; b != sights.end(); ++b) {
      if (!isParallel(a.ray, b->ray, minimum_angle))
        return true;
    }
  }
  return false;
}

Matrix3 acrossRay(const Ray& ray) {
  return Matrix3::Identity() - ray.direction * ray.direction.transpose();
}

/// d position / d pixel of the point with the least sum of squared distances to rays, to first
/// order, also where the rays miss each other. From sum P_i (position - origin_i) = 0 with
/// P_i = I - d_i d_i^T; `inverse` is (sum P_i)^-1.
Matrix32 positionByPixel(const Matrix3& inverse, const Vector3& position, const Sight& sight) {
  const Vector3 along = position - sight.ray.origin;
  const Vector3& d = sight.ray.direction;
  const Matrix3 change = d.dot(along) * Matrix3::Identity() + d * along.transpose();
  return inverse * change * sight.direction_by_pixel;
}

/// Mean over all pairs that are not parallel of the point halfway between the two rays.
Vector3 meanClosest(Sights& sights, double minimum_angle) {
  Vector3 sum = Vector3::Zero();
  int pairs = 0;
  for (Sight& s : sights)
    s.position_by_pixel.setZero();
  for (Sight& a : sights) {
    for (Sight* b = &a + 1; b != sights.end(); ++b) {
      if (isParallel(a.ray, b->ray, minimum_angle))
        continue;
      // The midpoint of two rays' closest points has the least squared distances to both.
      const Matrix3 across_b = acrossRay(b->ray);
      const Matrix3 inverse = (acrossRay(a.ray) + across_b).inverse();
      const Vector3 midpoint = a.ray.origin + inverse * (across_b * (b->ray.origin - a.ray.origin));
      sum += midpoint;
      a.position_by_pixel += positionByPixel(inverse, midpoint, a);
      b->position_by_pixel += positionByPixel(inverse, midpoint, *b);
      ++pairs;
    }
  }
  for (Sight& s : sights)
    s.position_by_pixel /= pairs;
  return sum / pairs;
}

/// Point with the least weighted sum of squared distances to all rays; weight: function of a sight.
template <typename Weight>
Vector3 leastSquares(Sights& sights, Matrix3* inverse, const Weight& weight) {
  const Vector3 base = sights.begin()->ray.origin;  // keeps the numbers small
  Matrix3 A = Matrix3::Zero();
  Vector3 b = Vector3::Zero();
  for (const Sight& s : sights) {
    const Matrix3 across = weight(s) * acrossRay(s.ray);
    A += across;
    b += across * (s.ray.origin - base);
  }
  *inverse = A.inverse();
  return base + *inverse * b;
}

Vector3 leastSquares(Sights& sights) {
  Matrix3 inverse;
  const Vector3 position = leastSquares(sights, &inverse, [](const Sight&) { return 1.0; });
  for (Sight& s : sights)
    s.position_by_pixel = positionByPixel(inverse, position, s);
  return position;
}

/// Midpoint in which each ray counts by its nearness: close to maximum likelihood already.
Vector3 weightedMidpoint(Sights& sights) {
  const Vector3 unweighted = leastSquares(sights);
  Matrix3 inverse;
  return leastSquares(sights, &inverse, [&](const Sight& s) {
    return 1.0 / std::max(1e-6, (unweighted - s.ray.origin).squaredNorm());
  });
}

Matrix3 linearCovariance(Sights& sights) {
  Matrix3 covariance = Matrix3::Zero();
  for (const Sight& s : sights)
    covariance += s.position_by_pixel * s.position_by_pixel.transpose();
  return covariance;
}

/// Sum of squared pixel residuals at a point [px^2]; nothing when a camera cannot see it.
std::optional<double> squaredResiduals(const std::vector<Observation>& observations,
                                       const Vector3& position) {
  double sum = 0.0;
  for (const Observation& o : observations) {
    const std::optional<Vector2> pixel = o.camera->project(position);
    if (!pixel)
      return std::nullopt;
    sum += (*pixel - o.pixel).squaredNorm();
  }
  return sum;
}

/// Gauss-Newton on the pixel residuals, from and into *position. *information becomes J^T J
/// [px^2/m^2] at the result. False when it does not settle.
bool minimizeReprojectionError(const std::vector<Observation>& observations,
                               Vector3* position,
                               Matrix3* information) {
  constexpr int kMaximumSteps = 100;
  constexpr int kMaximumHalvings = 20;
  std::optional<double> cost = squaredResiduals(observations, *position);
  for (int i = 0; cost && i < kMaximumSteps; ++i) {
    Matrix3 JtJ = Matrix3::Zero();
    Vector3 Jtr = Vector3::Zero();
    for (const Observation& o : observations) {
      Eigen::Matrix<double, 2, 3> J;
      const std::optional<Vector2> pixel = o.camera->project(*position, &J);
      if (!pixel)
        return false;
      JtJ.noalias() += J.transpose() * J;
      Jtr.noalias() += J.transpose() * (*pixel - o.pixel);
    }
    *information = JtJ;
    Vector3 step = JtJ.ldlt().solve(Jtr);
    // The gain [px^2] that the linear model promises has become too small to be told from rounding.
    if (step.dot(Jtr) <= 1e-18 + 1e-9 * *cost) {
      *position -= step;
      return true;
    }
    std::optional<double> next_cost = squaredResiduals(observations, *position - step);
    for (int k = 0; k < kMaximumHalvings && !(next_cost && *next_cost < *cost); ++k) {
      step *= 0.5;
      next_cost = squaredResiduals(observations, *position - step);
    }
    if (!(next_cost && *next_cost < *cost))
      return false;
    *position -= step;
    cost = next_cost;
  }
  return false;
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(const std::vector<Observation>& observations,
                                             const TriangulationOptions& options) {
  if (observations.size() < 2)
    return std::nullopt;
  Sights sights(observations.size());
  Sight* sight = sights.begin();
  for (const Observation& o : observations) {
    const std::optional<Ray> ray = rayFromPixel(*o.camera, o.pixel, &sight->direction_by_pixel);
    if (!ray)
      return std::nullopt;
    (sight++)->ray = *ray;
  }
  if (!haveAngle(sights, options.minimum_angle))
    return std::nullopt;

  TriangulatedPoint point;
  const double pixel_variance = options.pixel_stddev * options.pixel_stddev;
  switch (options.method) {
    case TriangulationMethod::kMeanClosest:
      point.position = meanClosest(sights, options.minimum_angle);
      point.covariance = pixel_variance * linearCovariance(sights);
      break;
    case TriangulationMethod::kLeastSquares:
      point.position = leastSquares(sights);
      point.covariance = pixel_variance * linearCovariance(sights);
      break;
    case TriangulationMethod::kMaximumLikelihood: {
      point.position = weightedMidpoint(sights);
      Matrix3 information;
      if (!minimizeReprojectionError(observations, &point.position, &information))
        return std::nullopt;
      point.covariance = pixel_variance * information.inverse();
      break;
    }
  }
  const std::optional<double> residuals = squaredResiduals(observations, point.position);
  if (!residuals || !point.position.allFinite() || !point.covariance.allFinite())
    return std::nullopt;
  point.reprojection_error = std::sqrt(*residuals / static_cast<double>(observations.size()));
  return point;
}

}  // namespace wiimote_tracker::geometry
