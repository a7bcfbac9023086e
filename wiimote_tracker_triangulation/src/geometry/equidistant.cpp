#include "distortion.h"
#include "wiimote_tracker_triangulation/geometry/lens_model.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::geometry::equidistant {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

/// Limit of the model: near a right angle, the point on the image plane goes to infinity [rad].
constexpr double kLargestAngle = 1.55;

double radiusOf(const Coefficients& k, double angle) {
  return equidistantRadius(k.data(), angle);
}

double slopeOf(const Coefficients& k, double angle) {
  const double s = angle * angle;
  return 1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * 9.0 * k[3])));
}

bool growsUpTo(const Coefficients& k, double angle) {
  return angle <= kLargestAngle && geometry::growsUpTo({k[0], k[1], k[2], k[3]}, angle * angle);
}

}  // namespace

Vector2 distort(const Coefficients& k, const Vector2& n, Matrix2* jacobian) {
  if (jacobian) {
    const double squared = n.squaredNorm();
    jacobian->setIdentity();
    if (squared > 1e-100) {  // on the axis the division below has no value
      const double r = std::sqrt(squared);
      const double angle = std::atan(r);
      const double scale = radiusOf(k, angle) / r;
      const double along = slopeOf(k, angle) / (1.0 + squared);  // d radius / d r
      *jacobian = (along - scale) / squared * n * n.transpose();
      jacobian->diagonal().array() += scale;
    }
  }
  return distortEquidistant(k.data(), n);
}

std::optional<Vector2> undistort(const Coefficients& k, const Vector2& target) {
  const double radius = target.norm();
  if (!(radius > 0.0))
    return target;
  // Newton's method from inside the fold; steps are halved until they stay inside and improve.
  constexpr int kMaximumSteps = 50;
  constexpr int kMaximumHalvings = 30;
  const double tolerance = 1e-15 * (1.0 + radius);
  double angle = std::min(radius, kLargestAngle);
  for (int i = 0; i < kMaximumHalvings && !growsUpTo(k, angle); ++i)
    angle *= 0.5;
  double error = radiusOf(k, angle) - radius;
  for (int i = 0; i < kMaximumSteps && std::abs(error) > tolerance; ++i) {
    double step = error / slopeOf(k, angle);
    double next = angle - step;
    double next_error = radiusOf(k, next) - radius;
    for (int j = 0; j < kMaximumHalvings; ++j) {
      if (std::abs(next_error) < std::abs(error) && next >= 0.0 && growsUpTo(k, next))
        break;
      step *= 0.5;
      next = angle - step;
      next_error = radiusOf(k, next) - radius;
    }
    if (!(std::abs(next_error) < std::abs(error)))
      break;  // rounding or the fold allow no further step
    angle = next;
    error = next_error;
  }
  if (!(std::abs(error) <= 1e-13 * (1.0 + radius)) || !growsUpTo(k, angle))
    return std::nullopt;
  return std::tan(angle) / radius * target;
}

bool isBeforeFold(const Coefficients& k, const Vector2& n) {
  return growsUpTo(k, std::atan(n.norm()));
}

}  // namespace wiimote_tracker::geometry::equidistant
