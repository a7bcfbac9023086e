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

/// d radius / d angle, see equidistantRadius().
double slopeOf(const Coefficients& k, double angle) {
  const double s = angle * angle;
  return 1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * 9.0 * k[3])));
}

Vector2 distort(const Coefficients& k, const Vector2& n, Matrix2* jacobian) {
  if (jacobian) {
    const double squared = n.squaredNorm();
    jacobian->setIdentity();
    if (squared > 1e-100) {  // on the axis the division below has no value
      const double r = std::sqrt(squared);
      const double angle = std::atan(r);
      const double scale = equidistantRadius(k.data(), angle) / r;
      const double along = slopeOf(k, angle) / (1.0 + squared);  // d radius / d r
      *jacobian = (along - scale) / squared * n * n.transpose();
      jacobian->diagonal().array() += scale;
    }
  }
  return distortEquidistant(k.data(), n);
}

Vector2 undistortIdeal(const Vector2& distorted) {
  const double angle = distorted.norm();
  return angle > 0.0 ? Vector2(std::tan(std::min(angle, kLargestAngle)) / angle * distorted)
                     : distorted;
}

/// Not beyond the largest angle either.
bool isBeforeFold(const Coefficients& k, const Vector2& n, const Matrix2& /*jacobian*/) {
  const double angle = std::atan(n.norm());
  return angle <= kLargestAngle && growsUpTo({k[0], k[1], k[2], k[3]}, angle * angle);
}

}  // namespace

const LensFormulas kFormulas = {"equidistant", "k1, k2, k3, k4", 4,
                                distort,       undistortIdeal,   isBeforeFold};

}  // namespace wiimote_tracker::geometry::equidistant
