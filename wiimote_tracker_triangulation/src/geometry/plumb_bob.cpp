#include "distortion.h"
#include "wiimote_tracker_triangulation/geometry/lens_model.h"

#include <Eigen/LU>

namespace wiimote_tracker::geometry::plumb_bob {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

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

Vector2 undistortIdeal(const Vector2& distorted) {
  return distorted;
}

bool isBeforeFold(const Coefficients& k, const Vector2& n, const Matrix2& jacobian) {
  return growsUpTo({k[0], k[1], k[4], 0.0}, n.squaredNorm()) && jacobian.determinant() > 0.0;
}

}  // namespace

const LensFormulas kFormulas = {"plumb_bob", "k1, k2, p1, p2, k3", 5,
                                distort,     undistortIdeal,       isBeforeFold};

}  // namespace wiimote_tracker::geometry::plumb_bob
