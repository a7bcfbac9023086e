#include "wiimote_tracker_triangulation/geometry/camera.h"

#include "distortion.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <cmath>
#include <string>

namespace wiimote_tracker::geometry {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

void require(bool good, const std::string& what, double value) {
  if (!good)
    throw InvalidRigError(what + " (is " + std::to_string(value) + "); calibrate again");
}

// No switch over the models has a default, so that the compiler finds where a new one is missing.
// GCC wants a return after the switch: that of the case that breaks.

Vector2 distort(const Intrinsics& lens, const Vector2& normalized, Matrix2* jacobian) {
  switch (lens.distortion_model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return equidistant::distort(lens.distortion, normalized, jacobian);
  }
  return plumb_bob::distort(lens.distortion, normalized, jacobian);
}

/// @param jacobian d pixel / d normalized, there.
bool isBeforeFold(const Intrinsics& lens, const Vector2& normalized, const Matrix2& jacobian) {
  switch (lens.distortion_model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return equidistant::isBeforeFold(lens.distortion, normalized);
  }
  return plumb_bob::isBeforeFold(lens.distortion, normalized, jacobian);
}

}  // namespace

const char* nameOf(DistortionModel model) {
  switch (model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return "equidistant";
  }
  return "plumb_bob";
}

std::optional<DistortionModel> distortionModelFromName(const std::string& name) {
  for (const DistortionModel model : kDistortionModels) {
    if (name == nameOf(model))
      return model;
  }
  return std::nullopt;
}

const char* coefficientNames(DistortionModel model) {
  switch (model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return "k1, k2, k3, k4";
  }
  return "k1, k2, p1, p2, k3";
}

std::size_t coefficientCount(DistortionModel model) {
  switch (model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return 4;
  }
  return 5;
}

std::string describeDistortionModels() {
  std::string text;
  for (const DistortionModel model : kDistortionModels)
    text += std::string(text.empty() ? "" : " or ") + nameOf(model) + " (" +
            coefficientNames(model) + ")";
  return text;
}

Vector2 Intrinsics::pixelFromNormalized(const Vector2& normalized, Matrix2* jacobian) const {
  const Vector2 distorted = distort(*this, normalized, jacobian);
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
  switch (distortion_model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return equidistant::undistort(distortion, target);
  }
  return plumb_bob::undistort(distortion, target);
}

bool Intrinsics::isInImage(const Vector2& pixel, double margin) const {
  return pixel.x() >= -margin && pixel.x() <= width - 1 + margin && pixel.y() >= -margin &&
         pixel.y() <= height - 1 + margin;
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
  for (std::size_t k = coefficientCount(distortion_model); k < distortion.size(); ++k)
    require(distortion[k] == 0.0,
            std::string("lens model ") + nameOf(distortion_model) + " has the coefficients " +
                coefficientNames(distortion_model) + ", and any after them must be 0",
            distortion[k]);
}

std::optional<Vector2> Camera::project(const Eigen::Vector3d& point,
                                       Eigen::Matrix<double, 2, 3>* jacobian) const {
  const Eigen::Matrix3d camera_from_world = world_from_camera.linear().transpose();
  const Eigen::Vector3d p = camera_from_world * (point - center());
  if (!(p.z() > 0.0))
    return std::nullopt;
  const Vector2 normalized = p.head<2>() / p.z();
  if (!normalized.allFinite())
    return std::nullopt;
  Matrix2 pixel_by_normalized;
  const Vector2 pixel = intrinsics.pixelFromNormalized(normalized, &pixel_by_normalized);
  if (!isBeforeFold(intrinsics, normalized, pixel_by_normalized))
    return std::nullopt;
  if (!jacobian)
    return pixel;
  // Of (x, y) = (X, Y) / Z: d x = (d X - x d Z) / Z.
  const auto rotation = world_from_camera.linear();
  for (int i = 0; i < 2; ++i) {
    const Vector2 slope = pixel_by_normalized.row(i).transpose() / p.z();
    const Eigen::Vector3d by_p(slope.x(), slope.y(), -slope.dot(normalized));
    jacobian->row(i) = (rotation * by_p).transpose();
  }
  return pixel;
}

bool Camera::sees(const Eigen::Vector3d& point) const {
  const std::optional<Vector2> pixel = project(point);
  return pixel && intrinsics.isInImage(*pixel);
}

bool haveSamePose(const Camera& a, const Camera& b) {
  constexpr double kTurn = 0.002;      // some pixels [rad]
  constexpr double kDistance = 0.005;  // [m]
  const Eigen::AngleAxisd turn(a.world_from_camera.linear().transpose() *
                               b.world_from_camera.linear());
  return turn.angle() < kTurn && (b.center() - a.center()).norm() < kDistance;
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
