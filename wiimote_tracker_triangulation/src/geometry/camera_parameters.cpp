#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

#include <cmath>

namespace wiimote_tracker::geometry {

namespace {

constexpr Eigen::Index kLensParameters = kTimeOffset - kLens;
using LensJacobian = Eigen::Matrix<double, 2, kLensParameters>;

/// Pixels are linear in each parameter of each lens model, so that a difference is exact; and no
/// model is written out here.
LensJacobian lensJacobian(const Intrinsics& lens, const Eigen::Vector2d& normalized) {
  LensJacobian jacobian = LensJacobian::Zero();
  const auto column = [&](double Intrinsics::*value, double step) {
    Intrinsics more = lens;
    Intrinsics less = lens;
    more.*value += step;
    less.*value -= step;
    return Eigen::Vector2d(
        (more.pixelFromNormalized(normalized) - less.pixelFromNormalized(normalized)) /
        (2.0 * step));
  };
  const double kPixel = 1.0;
  jacobian.col(0) = column(&Intrinsics::fx, kPixel);
  jacobian.col(1) = column(&Intrinsics::fy, kPixel);
  jacobian.col(2) = column(&Intrinsics::cx, kPixel);
  jacobian.col(3) = column(&Intrinsics::cy, kPixel);
  for (std::size_t k = 0; k < coefficientCount(lens.distortion_model); ++k) {
    const double kStep = 1e-3;
    Intrinsics more = lens;
    Intrinsics less = lens;
    more.distortion[k] += kStep;
    less.distortion[k] -= kStep;
    jacobian.col(kDistortion - kLens + static_cast<Eigen::Index>(k)) =
        (more.pixelFromNormalized(normalized) - less.pixelFromNormalized(normalized)) /
        (2.0 * kStep);
  }
  return jacobian;
}

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d result;
  result << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return result;
}

}  // namespace

std::optional<Projection> projectionOf(const Camera& camera, const Eigen::Vector3d& point) {
  Projection projection;
  const auto pixel = camera.project(point, &projection.by_point);
  if (!pixel)
    return std::nullopt;
  projection.pixel = *pixel;
  const Eigen::Vector3d from_center = point - camera.center();
  const Eigen::Vector3d in_camera = camera.world_from_camera.linear().transpose() * from_center;
  const Eigen::Vector2d normalized = in_camera.head<2>() / in_camera.z();

  projection.by_parameters.setZero();
  // exp([w]x) turns the camera, which is turning the point the other way.
  projection.by_parameters.middleCols<3>(kRotation) =
      projection.by_point * crossMatrix(from_center);
  projection.by_parameters.middleCols<3>(kPosition) = -projection.by_point;
  projection.by_parameters.middleCols<kLensParameters>(kLens) =
      lensJacobian(camera.intrinsics, normalized);
  return projection;
}

std::optional<Projection> rayProjection(const Rig& rig,
                                        std::size_t index,
                                        const Eigen::Vector3d& point) {
  const RigCamera& camera = rig.cameras[index];
  auto projection = projectionOf(rig.rayCamera(camera), point);
  if (projection && rig.ray_model == RayModel::kImageCenter) {
    // The virtual model keeps at most the focal length of the calibrated one.
    const Eigen::Index first = std::isnan(rig.virtual_hfov) ? kLens + 2 : kLens;
    projection->by_parameters.middleCols(first, kTimeOffset - first).setZero();
  }
  return projection;
}

}  // namespace wiimote_tracker::geometry
