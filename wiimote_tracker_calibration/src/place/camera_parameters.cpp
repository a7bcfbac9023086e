#include "wiimote_tracker_calibration/place/camera_parameters.h"

#include <cmath>

namespace wiimote_tracker::place {

namespace {

constexpr Eigen::Index kLensParameters = kTimeOffset - kLens;
using LensJacobian = Eigen::Matrix<double, 2, kLensParameters>;

/// Pixels are linear in each parameter of each lens model, so that a difference is exact; and no
/// model is written out here.
LensJacobian lensJacobian(const geometry::Intrinsics& lens, const Eigen::Vector2d& normalized) {
  LensJacobian jacobian = LensJacobian::Zero();
  const auto column = [&](double geometry::Intrinsics::*value, double step) {
    geometry::Intrinsics more = lens;
    geometry::Intrinsics less = lens;
    more.*value += step;
    less.*value -= step;
    return Eigen::Vector2d(
        (more.pixelFromNormalized(normalized) - less.pixelFromNormalized(normalized)) /
        (2.0 * step));
  };
  const double kPixel = 1.0;
  jacobian.col(0) = column(&geometry::Intrinsics::fx, kPixel);
  jacobian.col(1) = column(&geometry::Intrinsics::fy, kPixel);
  jacobian.col(2) = column(&geometry::Intrinsics::cx, kPixel);
  jacobian.col(3) = column(&geometry::Intrinsics::cy, kPixel);
  for (std::size_t k = 0; k < geometry::coefficientCount(lens.distortion_model); ++k) {
    const double kStep = 1e-3;
    geometry::Intrinsics more = lens;
    geometry::Intrinsics less = lens;
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

std::optional<Projection> projectionOf(const geometry::Camera& camera,
                                       const Eigen::Vector3d& point) {
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

std::optional<Projection> rayProjection(const geometry::Rig& rig,
                                        std::size_t index,
                                        const Eigen::Vector3d& point) {
  const geometry::RigCamera& camera = rig.cameras[index];
  auto projection = projectionOf(rig.rayCamera(camera), point);
  if (projection && rig.ray_model == geometry::RayModel::kImageCenter) {
    // The virtual model keeps at most the focal length of the calibrated one.
    const Eigen::Index first = std::isnan(rig.virtual_hfov) ? kLens + 2 : kLens;
    projection->by_parameters.middleCols(first, kTimeOffset - first).setZero();
  }
  return projection;
}

}  // namespace wiimote_tracker::place
