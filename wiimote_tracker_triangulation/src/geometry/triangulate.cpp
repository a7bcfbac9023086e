#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <Eigen/LU>
#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::geometry {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// A range of sights; not owned.
struct Sights {
  const Sight* first;
  std::size_t count;

  const Sight* begin() const { return first; }
  const Sight* end() const { return first + count; }
};

/// Compares sines, which are exact for small angles. Opposite directions are parallel, too.
bool isParallel(const Sight& a, const Sight& b, double minimum_sine_squared) {
  return !(a.direction.cross(b.direction).squaredNorm() >= minimum_sine_squared);
}

bool haveAngle(const Sights& sights, double minimum_sine_squared) {
  for (const Sight& a : sights) {
    for (const Sight* b = &a + 1; b != sights.end(); ++b) {
      if (!isParallel(a, *b, minimum_sine_squared))
        return true;
    }
  }
  return false;
}

Matrix3 acrossRay(const Sight& sight) {
  return Matrix3::Identity() - sight.direction * sight.direction.transpose();
}

/// d position / d pixel of the point with the least sum of squared distances to rays, to first
/// order, also where the rays miss each other. From sum P_i (position - origin_i) = 0 with
/// P_i = I - d_i d_i^T; `inverse` is (sum P_i)^-1.
Matrix32 positionByPixel(const Matrix3& inverse, const Vector3& position, const Sight& sight) {
  const Vector3 along = position - sight.origin;
  const Vector3& d = sight.direction;
  const Matrix3 change = d.dot(along) * Matrix3::Identity() + d * along.transpose();
  return inverse * change * sight.directionByPixel();
}

/// The point with the least weighted sum of squared distances to all rays, and the inverse of its
/// normal equations.
struct Nearest {
  template <typename Weight>
  Nearest(const Sights& sights, const Weight& weight) {
    const Vector3 base = sights.first->origin;  // keeps the numbers small
    Matrix3 normal = Matrix3::Zero();
    Vector3 right = Vector3::Zero();
    for (const Sight& s : sights) {
      const Matrix3 across = weight(s) * acrossRay(s);
      normal += across;
      right += across * (s.origin - base);
    }
    inverse = normal.inverse();
    position = base + inverse * right;
  }
  Matrix3 inverse;
  Vector3 position;
};

constexpr auto kEqualWeights = [](const Sight&) { return 1.0; };

/// Mean over all pairs that are not parallel of the point halfway between the two rays.
void meanClosest(const Sights& sights, double minimum_sine_squared, TriangulatedPoint* point) {
  Vector3 sum = Vector3::Zero();
  int pairs = 0;
  Matrix3 variance = Matrix3::Zero();
  for (const Sight& a : sights) {
    Matrix32 position_by_pixel = Matrix32::Zero();  // the sum over the pairs of which a is one
    for (const Sight& b : sights) {
      if (&a == &b || isParallel(a, b, minimum_sine_squared))
        continue;
      const Sight pair[] = {a, b};
      const Nearest midpoint({pair, 2}, kEqualWeights);  // halfway between their closest points
      position_by_pixel += positionByPixel(midpoint.inverse, midpoint.position, a);
      if (&a < &b) {
        sum += midpoint.position;
        ++pairs;
      }
    }
    variance += position_by_pixel * position_by_pixel.transpose();
  }
  point->position = sum / pairs;
  point->covariance = variance / (pairs * pairs);
}

/// The covariance neglects that the weights change with the pixels.
template <typename Weight>
void takeNearest(const Sights& sights, const Weight& weight, TriangulatedPoint* point) {
  const Nearest nearest(sights, weight);
  point->position = nearest.position;
  point->covariance.setZero();
  for (const Sight& s : sights) {
    const Matrix32 position_by_pixel =
        weight(s) * positionByPixel(nearest.inverse, nearest.position, s);
    point->covariance += position_by_pixel * position_by_pixel.transpose();
  }
}

/// First with equal weights, then with each ray's distance in pixels at the depth of the result.
void reweightedMidpoint(const Sights& sights, TriangulatedPoint* point) {
  const Vector3 first = Nearest(sights, kEqualWeights).position;
  takeNearest(
      sights,
      [&](const Sight& s) {
        const double depth = s.depth(first);
        return s.pixel_by_offset.squaredNorm() / (depth * depth);
      },
      point);
}

/// Gauss-Newton on the residuals. False when it does not converge.
bool maximumLikelihood(const Sights& sights, TriangulatedPoint* point) {
  constexpr int kMaximumSteps = 100;
  constexpr double kNegligible = 1e-6;  // share of the cost, far below the noise
  constexpr double kRounding = 1e-18;   // [px^2]
  Vector3 position = Nearest(sights, kEqualWeights).position;
  Vector3 step = Vector3::Zero();
  double best_cost = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaximumSteps; ++i) {
    Matrix3 normal = Matrix3::Zero();
    Vector3 gradient = Vector3::Zero();
    double cost = 0.0;
    double least_depth = std::numeric_limits<double>::infinity();
    for (const Sight& s : sights) {
      const Vector3 offset = position - s.origin;
      const double depth = s.axis.dot(offset);
      const double scale = 1.0 / depth;
      const Vector2 residual = scale * (s.pixel_by_offset * offset);
      const Matrix23 jacobian = scale * (s.pixel_by_offset - residual * s.axis.transpose());
      normal.noalias() += jacobian.transpose() * jacobian;
      gradient.noalias() += jacobian.transpose() * residual;
      cost += residual.squaredNorm();
      least_depth = std::min(least_depth, depth);
    }
    if (!(least_depth > 0.0 && cost < best_cost)) {
      step *= 0.5;  // the last step went too far
      position += step;
      continue;
    }
    best_cost = cost;
    point->covariance = normal.inverse();
    step = point->covariance * gradient;
    position -= step;
    // Estimate of what the next step gains as a share of what this one gains, which is the square
    // of the ratio of their lengths: the derivatives change along the step, and their curvature
    // (one over the depth) counts with the residuals, most where the point is badly determined.
    const double n = sights.count;
    const double badly_determined = point->covariance.trace() * normal.trace() / (n * n);
    const double next_share =
        (step.squaredNorm() + cost * point->covariance.trace() * badly_determined) /
        (least_depth * least_depth);
    if (next_share * step.dot(gradient) <= kRounding + kNegligible * cost) {
      point->position = position;
      return true;
    }
  }
  return false;
}

double reprojectionError(const Sights& sights, const Vector3& position) {
  double squared_residuals = 0.0;
  for (const Sight& s : sights)
    squared_residuals += s.residual(position).squaredNorm();
  return std::sqrt(squared_residuals / sights.count);
}

bool isInFront(const Sights& sights, const Vector3& position) {
  return std::all_of(sights.begin(), sights.end(),
                     [&](const Sight& s) { return s.depth(position) > 0.0; });
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(const Sight* first,
                                             std::size_t count,
                                             const TriangulationOptions& options) {
  const Sights sights{first, count};
  const double minimum_sine_squared = std::pow(std::sin(options.minimum_angle), 2);
  if (count < 2 || !haveAngle(sights, minimum_sine_squared))
    return std::nullopt;
  TriangulatedPoint point{Vector3::Zero(), Matrix3::Zero(), 0.0};
  switch (options.method) {
    case TriangulationMethod::kMeanClosest:
      meanClosest(sights, minimum_sine_squared, &point);
      break;
    case TriangulationMethod::kLeastSquares:
      takeNearest(sights, kEqualWeights, &point);
      break;
    case TriangulationMethod::kReweightedMidpoint:
      reweightedMidpoint(sights, &point);
      break;
    case TriangulationMethod::kMaximumLikelihood:
      if (!maximumLikelihood(sights, &point))
        return std::nullopt;
      break;
  }
  point.covariance *= options.pixel_stddev * options.pixel_stddev;
  if (!isInFront(sights, point.position) || !point.position.allFinite() ||
      !point.covariance.allFinite())
    return std::nullopt;
  point.reprojection_error = reprojectionError(sights, point.position);
  return point;
}

std::optional<TriangulatedPoint> triangulate(const std::vector<Observation>& observations,
                                             const TriangulationOptions& options) {
  boost::container::small_vector<Sight, 16> sights;
  for (const Observation& o : observations) {
    const std::optional<Sight> sight = sightFromPixel(*o.camera, o.pixel);
    if (!sight)
      return std::nullopt;
    sights.push_back(*sight);
  }
  std::optional<TriangulatedPoint> point = triangulate(sights.data(), sights.size(), options);
  if (!point)
    return std::nullopt;
  double squared_residuals = 0.0;
  for (const Observation& o : observations) {
    const std::optional<Vector2> pixel = o.camera->project(point->position);
    if (!pixel)
      return std::nullopt;
    squared_residuals += (*pixel - o.pixel).squaredNorm();
  }
  point->reprojection_error = std::sqrt(squared_residuals / observations.size());
  return point;
}

}  // namespace wiimote_tracker::geometry
