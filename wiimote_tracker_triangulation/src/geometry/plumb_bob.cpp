#include "distortion.h"
#include "wiimote_tracker_triangulation/geometry/lens_model.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::geometry::plumb_bob {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

/// Whether the radius grows monotonically up to the squared radius s:
/// d/dr (r + k1 r^3 + k2 r^5 + k3 r^7) = 1 + 3 k1 s + 5 k2 s^2 + 7 k3 s^3 > 0 on [0, s].
bool radiusGrowsUpTo(const Coefficients& k, double s) {
  const double a = 3.0 * k[0];
  const double b = 5.0 * k[1];
  const double c = 7.0 * k[4];
  const auto slope = [&](double t) { return 1.0 + t * (a + t * (b + t * c)); };
  if (!(slope(s) > 0.0))
    return false;
  if (a >= 0.0 && b >= 0.0 && c >= 0.0)
    return true;
  // The least slope is at an end or where its derivative a + 2 b t + 3 c t^2 is zero. This form of
  // the roots does not cancel and also holds for c = 0.
  const double discriminant = b * b - 3.0 * a * c;
  if (discriminant < 0.0)
    return true;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double roots[] = {c != 0.0 ? q / (3.0 * c) : -1.0, q != 0.0 ? a / q : -1.0};
  return std::all_of(std::begin(roots), std::end(roots),
                     [&](double t) { return !(t > 0.0 && t < s) || slope(t) > 0.0; });
}

bool isBeforeFold(const Coefficients& k, const Vector2& n) {
  Matrix2 jacobian;
  return distortBeforeFold(k, n, &jacobian).has_value();
}

}  // namespace

Vector2 distort(const Coefficients& k, const Vector2& n, Matrix2* jacobian) {
  if (jacobian) {
    const auto [k1, k2, p1, p2, k3] = k;
    const double x = n.x();
    const double y = n.y();
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // d radial / d x, over x
    const double cross = slope * x * y + 2.0 * (p1 * x + p2 * y);
    *jacobian << radial + slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x, cross,  //
        cross, radial + slope * y * y + 6.0 * p1 * y + 2.0 * p2 * x;
  }
  return distortPlumbBob(k.data(), n);
}

std::optional<Vector2> undistort(const Coefficients& k, const Vector2& target) {
  // Newton's method from inside the fold; steps are halved until they stay inside and improve.
  constexpr int kMaximumSteps = 50;
  constexpr int kMaximumHalvings = 30;
  const double tolerance = 1e-14 * (1.0 + target.norm());
  Vector2 n = target;
  for (int i = 0; i < kMaximumHalvings && !isBeforeFold(k, n); ++i)
    n *= 0.5;
  Matrix2 jacobian;
  Vector2 error = distort(k, n, &jacobian) - target;
  for (int i = 0; i < kMaximumSteps && error.norm() > tolerance; ++i) {
    Vector2 step = jacobian.inverse() * error;
    Vector2 next = n - step;
    Vector2 next_error = distort(k, next, nullptr) - target;
    for (int j = 0; j < kMaximumHalvings; ++j) {
      if (next_error.norm() < error.norm() && isBeforeFold(k, next))
        break;
      step *= 0.5;
      next = n - step;
      next_error = distort(k, next, nullptr) - target;
    }
    if (!(next_error.norm() < error.norm()))
      break;  // rounding or the fold allow no further step
    n = next;
    error = distort(k, n, &jacobian) - target;
  }
  if (!(error.norm() <= 1e-12 * (1.0 + target.norm())) || !isBeforeFold(k, n))
    return std::nullopt;
  return n;
}

std::optional<Vector2> distortBeforeFold(const Coefficients& k,
                                         const Vector2& n,
                                         Matrix2* jacobian) {
  if (!radiusGrowsUpTo(k, n.squaredNorm()))
    return std::nullopt;
  const Vector2 distorted = distort(k, n, jacobian);
  if (!(jacobian->determinant() > 0.0))
    return std::nullopt;
  return distorted;
}

}  // namespace wiimote_tracker::geometry::plumb_bob
