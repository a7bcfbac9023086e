#include "distortion.h"
#include "wiimote_tracker_triangulation/geometry/lens_model.h"

#include <Eigen/LU>

namespace wiimote_tracker::geometry::plumb_bob {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

bool isBeforeFold(const Coefficients& k, const Vector2& n) {
  Matrix2 jacobian;
  distort(k, n, &jacobian);
  return plumb_bob::isBeforeFold(k, n, jacobian);
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

bool isBeforeFold(const Coefficients& k, const Vector2& n, const Matrix2& jacobian) {
  return growsUpTo({k[0], k[1], k[4], 0.0}, n.squaredNorm()) && jacobian.determinant() > 0.0;
}

}  // namespace wiimote_tracker::geometry::plumb_bob
