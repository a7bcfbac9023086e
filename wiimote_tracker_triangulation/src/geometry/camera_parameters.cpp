#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

#include "wiimote_tracker_triangulation/geometry/lens_model.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <array>
#include <cmath>

namespace wiimote_tracker::geometry {

namespace {

constexpr Eigen::Index kLensParameters = kTimeOffset - kIntrinsics;
using LensJacobian = Eigen::Matrix<double, 2, kLensParameters>;

/// Pixels are linear in each parameter of the lens, so that differences are exact.
LensJacobian lensJacobian(const Intrinsics& lens, const Eigen::Vector2d& normalized) {
  const auto distorted = [&](const std::array<double, 5>& coefficients) {
    return distort(lens.distortion_model, coefficients.data(), normalized);
  };
  const Eigen::Vector2d focal(lens.fx, lens.fy);
  const Eigen::Vector2d undistorted = distorted({});
  LensJacobian jacobian = LensJacobian::Zero();
  jacobian.leftCols<2>() = distorted(lens.distortion).asDiagonal();
  jacobian.middleCols<2>(2).setIdentity();
  for (std::size_t k = 0; k < coefficientCount(lens.distortion_model); ++k) {
    std::array<double, 5> one{};
    one[k] = 1.0;
    jacobian.col(kDistortion - kIntrinsics + k) = focal.cwiseProduct(distorted(one) - undistorted);
  }
  return jacobian;
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
  projection.by_parameters.middleCols<3>(kRotation) = projection.by_point * so3::skew(from_center);
  projection.by_parameters.middleCols<3>(kPosition) = -projection.by_point;
  projection.by_parameters.middleCols<kLensParameters>(kIntrinsics) =
      lensJacobian(camera.intrinsics, normalized);
  return projection;
}

std::optional<Projection> rayProjection(const Rig& rig,
                                        std::size_t index,
                                        const Eigen::Vector3d& point) {
  const RigCamera& camera = rig.cameras[index];
  if (rig.ray_model == RayModel::kCalibrated)
    return projectionOf(camera.camera, point);
  RigCamera nameless;  // a copy of the name would allocate
  nameless.camera.intrinsics = camera.camera.intrinsics;
  nameless.camera.world_from_camera = camera.camera.world_from_camera;
  auto projection = projectionOf(rig.rayCamera(nameless), point);
  if (projection) {
    // The virtual model keeps at most the focal length of the calibrated one.
    const Eigen::Index first = std::isnan(rig.virtual_hfov) ? kIntrinsics + 2 : kIntrinsics;
    projection->by_parameters.middleCols(first, kTimeOffset - first).setZero();
  }
  return projection;
}

}  // namespace wiimote_tracker::geometry
