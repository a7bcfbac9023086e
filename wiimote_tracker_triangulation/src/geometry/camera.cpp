#include "wiimote_tracker_triangulation/geometry/camera.h"

#include "distortion.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <Eigen/LU>

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

/// The switch has no default, so that the compiler finds a new model that is missing here. GCC
/// wants a return after it: that of the case that breaks.
const LensFormulas& formulasOf(DistortionModel model) {
  switch (model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return equidistant::kFormulas;
  }
  return plumb_bob::kFormulas;
}

/// Newton's method from inside the fold; steps are halved until they stay inside and improve.
/// @returns nothing where no point before the fold has this image. @param target finite.
std::optional<Vector2> undistort(const LensFormulas& lens,
                                 const Coefficients& k,
                                 const Vector2& target) {
  constexpr int kMaximumSteps = 50;
  constexpr int kMaximumHalvings = 30;
  struct Trial {
    Vector2 n;
    Vector2 error;
    Matrix2 jacobian;
    bool is_inside;
  };
  const auto at = [&](const Vector2& n) {
    Trial trial;
    trial.n = n;
    trial.error = lens.distort(k, n, &trial.jacobian) - target;
    trial.is_inside = lens.isBeforeFold(k, n, trial.jacobian);
    return trial;
  };
  Trial best = at(lens.undistortIdeal(target));
  for (int i = 0; i < kMaximumHalvings && !best.is_inside; ++i)
    best = at(0.5 * best.n);
  const auto isBetter = [&](const Trial& trial) { return trial.error.norm() < best.error.norm(); };
  const double unit = 1.0 + target.norm();
  for (int i = 0; i < kMaximumSteps && best.error.norm() > 1e-14 * unit; ++i) {
    Vector2 step = best.jacobian.inverse() * best.error;
    Trial next = at(best.n - step);
    for (int j = 0; j < kMaximumHalvings && !(isBetter(next) && next.is_inside); ++j) {
      step *= 0.5;
      next = at(best.n - step);
    }
    if (!isBetter(next))
      break;  // rounding or the fold allow no further step
    best = next;
  }
  if (!best.is_inside || !(best.error.norm() <= 1e-12 * unit))
    return std::nullopt;
  return best.n;
}

}  // namespace

const char* nameOf(DistortionModel model) {
  return formulasOf(model).name;
}

const char* coefficientNames(DistortionModel model) {
  return formulasOf(model).coefficient_names;
}

std::size_t coefficientCount(DistortionModel model) {
  return formulasOf(model).coefficient_count;
}

std::optional<DistortionModel> distortionModelFromName(const std::string& name) {
  for (const DistortionModel model : kDistortionModels) {
    if (name == nameOf(model))
      return model;
  }
  return std::nullopt;
}

std::string describeDistortionModels() {
  std::string text;
  for (const DistortionModel model : kDistortionModels)
    text += std::string(text.empty() ? "" : " or ") + nameOf(model) + " (" +
            coefficientNames(model) + ")";
  return text;
}

Vector2 Intrinsics::pixelFromNormalized(const Vector2& normalized, Matrix2* jacobian) const {
  const Vector2 distorted = formulasOf(distortion_model).distort(distortion, normalized, jacobian);
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
  return undistort(formulasOf(distortion_model), distortion, target);
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
  if (!formulasOf(intrinsics.distortion_model)
           .isBeforeFold(intrinsics.distortion, normalized, pixel_by_normalized))
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
  return so3::angleBetween(a.world_from_camera.linear(), b.world_from_camera.linear()) < kTurn &&
         (b.center() - a.center()).norm() < kDistance;
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
