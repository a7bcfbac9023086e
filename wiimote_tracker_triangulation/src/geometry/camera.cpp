#include "wiimote_tracker_triangulation/geometry/camera.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker::geometry {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

/// Brown's distortion of a normalised point, with its derivative when asked for.
Vector2 distort(const std::array<double, 5>& distortion, const Vector2& n, Matrix2* jacobian) {
  const auto [k1, k2, p1, p2, k3] = distortion;
  const double x = n.x();
  const double y = n.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  if (jacobian) {
    const double slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // d radial / d x, over x
    const double cross = slope * x * y + 2.0 * (p1 * x + p2 * y);
    *jacobian << radial + slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x, cross,  //
        cross, radial + slope * y * y + 6.0 * p1 * y + 2.0 * p2 * x;
  }
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

/// Whether the radius grows all the way out to the squared radius s:
/// d/dr (r + k1 r^3 + k2 r^5 + k3 r^7) = 1 + 3 k1 s + 5 k2 s^2 + 7 k3 s^3 > 0 on [0, s].
bool radiusGrowsUpTo(const std::array<double, 5>& distortion, double s) {
  const double a = 3.0 * distortion[0];
  const double b = 5.0 * distortion[1];
  const double c = 7.0 * distortion[4];
  const auto slope = [&](double t) { return 1.0 + t * (a + t * (b + t * c)); };
  if (!(slope(s) > 0.0))
    return false;
  if (a >= 0.0 && b >= 0.0 && c >= 0.0)
    return true;
  // The least slope lies at an end or where its derivative a + 2 b t + 3 c t^2 is zero. The roots
  // are taken in the form that does not cancel and that also holds for c = 0.
  const double discriminant = b * b - 3.0 * a * c;
  if (discriminant < 0.0)
    return true;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double roots[] = {c != 0.0 ? q / (3.0 * c) : -1.0, q != 0.0 ? a / q : -1.0};
  return std::all_of(std::begin(roots), std::end(roots),
                     [&](double t) { return !(t > 0.0 && t < s) || slope(t) > 0.0; });
}

void require(bool good, const std::string& what, double value) {
  if (!good)
    throw InvalidRigError(what + " (is " + std::to_string(value) + "); calibrate again");
}

}  // namespace

Vector2 Intrinsics::pixelFromNormalized(const Vector2& normalized) const {
  return pixelFromNormalized(normalized, nullptr);
}

Vector2 Intrinsics::pixelFromNormalized(const Vector2& normalized, Matrix2* jacobian) const {
  const Vector2 distorted = distort(distortion, normalized, jacobian);
  if (jacobian) {
    jacobian->row(0) *= fx;
    jacobian->row(1) *= fy;
  }
  return {fx * distorted.x() + cx, fy * distorted.y() + cy};
}

std::optional<Vector2> Intrinsics::normalizedFromPixel(const Vector2& pixel) const {
  const Vector2 target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  if (!target.allFinite())
    return std::nullopt;

  // Newton's method from inside the fold, with steps halved until they stay there and gain.
  constexpr int kMaximumSteps = 50;
  constexpr int kMaximumHalvings = 30;
  const double tolerance = 1e-14 * (1.0 + target.norm());
  Vector2 n = target;
  for (int i = 0; i < kMaximumHalvings && !isBeforeFold(n); ++i)
    n *= 0.5;
  Matrix2 jacobian;
  Vector2 error = distort(distortion, n, &jacobian) - target;
  for (int i = 0; i < kMaximumSteps && error.norm() > tolerance; ++i) {
    Vector2 step = jacobian.inverse() * error;
    Vector2 next = n - step;
    Vector2 next_error = distort(distortion, next, nullptr) - target;
    for (int k = 0; k < kMaximumHalvings; ++k) {
      if (next_error.norm() < error.norm() && isBeforeFold(next))
        break;
      step *= 0.5;
      next = n - step;
      next_error = distort(distortion, next, nullptr) - target;
    }
    if (!(next_error.norm() < error.norm()))
      break;  // as close as rounding, or the fold, lets it come
    n = next;
    error = distort(distortion, n, &jacobian) - target;
  }
  if (!(error.norm() <= 1e-12 * (1.0 + target.norm())) || !isBeforeFold(n))
    return std::nullopt;
  return n;
}

bool Intrinsics::isBeforeFold(const Vector2& normalized) const {
  if (!radiusGrowsUpTo(distortion, normalized.squaredNorm()))
    return false;
  Matrix2 jacobian;
  distort(distortion, normalized, &jacobian);
  return jacobian.determinant() > 0.0;
}

void Intrinsics::check() const {
  require(width > 0, "width must be above 0 px", width);
  require(height > 0, "height must be above 0 px", height);
  require(std::isfinite(fx) && fx > 0.0, "fx must be above 0 px", fx);
  require(std::isfinite(fy) && fy > 0.0, "fy must be above 0 px", fy);
  require(std::isfinite(cx), "cx must be finite", cx);
  require(std::isfinite(cy), "cy must be finite", cy);
  for (const double k : distortion)
    require(std::isfinite(k), "every distortion coefficient must be finite", k);
}

std::optional<Vector2> Camera::project(const Eigen::Vector3d& point) const {
  return project(point, nullptr);
}

std::optional<Vector2> Camera::project(const Eigen::Vector3d& point,
                                       Eigen::Matrix<double, 2, 3>* jacobian) const {
  const Eigen::Matrix3d camera_from_world = world_from_camera.linear().transpose();
  const Eigen::Vector3d p = camera_from_world * (point - center());
  if (!(p.z() > 0.0))
    return std::nullopt;
  const Vector2 normalized = p.head<2>() / p.z();
  if (!normalized.allFinite() || !intrinsics.isBeforeFold(normalized))
    return std::nullopt;
  if (!jacobian)
    return intrinsics.pixelFromNormalized(normalized);
  Eigen::Matrix<double, 2, 3> normalized_by_p;
  normalized_by_p << 1.0, 0.0, -normalized.x(), 0.0, 1.0, -normalized.y();
  normalized_by_p /= p.z();
  Matrix2 pixel_by_normalized;
  const Vector2 pixel = intrinsics.pixelFromNormalized(normalized, &pixel_by_normalized);
  jacobian->noalias() = pixel_by_normalized * normalized_by_p * camera_from_world;
  return pixel;
}

bool Camera::sees(const Eigen::Vector3d& point) const {
  const std::optional<Vector2> pixel = project(point);
  return pixel && pixel->x() >= 0.0 && pixel->x() <= intrinsics.width - 1 && pixel->y() >= 0.0 &&
         pixel->y() <= intrinsics.height - 1;
}

std::optional<Ray> rayFromPixel(const Camera& camera, const Vector2& pixel) {
  return rayFromPixel(camera, pixel, nullptr);
}

std::optional<Ray> rayFromPixel(const Camera& camera,
                                const Vector2& pixel,
                                Eigen::Matrix<double, 3, 2>* jacobian) {
  const std::optional<Vector2> n = camera.intrinsics.normalizedFromPixel(pixel);
  if (!n)
    return std::nullopt;
  const Eigen::Matrix3d world_from_camera = camera.world_from_camera.linear();
  const double length = std::sqrt(n->squaredNorm() + 1.0);
  const Eigen::Vector3d direction(n->x() / length, n->y() / length, 1.0 / length);
  if (jacobian) {
    Matrix2 pixel_by_normalized;
    camera.intrinsics.pixelFromNormalized(*n, &pixel_by_normalized);
    Eigen::Matrix<double, 3, 2> direction_by_normalized =
        -direction * direction.head<2>().transpose();
    direction_by_normalized.topRows<2>() += Matrix2::Identity();
    *jacobian =
        world_from_camera * direction_by_normalized * pixel_by_normalized.inverse() / length;
  }
  return Ray{camera.center(), world_from_camera * direction};
}

Eigen::Isometry3d lookAt(const Eigen::Vector3d& position,
                         const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = (target - position).normalized();
  const Eigen::Vector3d x = z.cross(up.normalized());
  if (!(x.norm() > 1e-9))
    throw InvalidRigError("the camera looks along its up direction; choose another target or up");
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  world_from_camera.linear().col(0) = x.normalized();
  world_from_camera.linear().col(1) = z.cross(x.normalized());
  world_from_camera.linear().col(2) = z;
  world_from_camera.translation() = position;
  return world_from_camera;
}

}  // namespace wiimote_tracker::geometry
