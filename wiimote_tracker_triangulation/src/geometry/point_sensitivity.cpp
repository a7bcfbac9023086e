#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>

namespace wiimote_tracker::geometry {

bool pointSensitivity(const Rig& rig,
                      const Eigen::Vector3d& point,
                      const std::size_t* cameras,
                      std::size_t count,
                      PointJacobian* by_camera,
                      const Eigen::Vector3d& velocity) {
  // Less than for any angle between rays that triangulate() accepts.
  constexpr double kSingular = 1e-10;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    auto projection = rayProjection(rig, cameras[i], point);
    if (!projection)
      return false;
    projection->by_parameters.col(kTimeOffset).noalias() = projection->by_point * velocity;
    information.noalias() += projection->by_point.transpose() * projection->by_point;
    by_camera[i].noalias() = projection->by_point.transpose() * projection->by_parameters;
  }
  const double trace = information.trace();
  if (!(information.determinant() > kSingular * trace * trace * trace))
    return false;
  const Eigen::Matrix3d inverse = information.inverse();
  for (std::size_t i = 0; i < count; ++i)
    by_camera[i] = -inverse * by_camera[i];
  return true;
}

std::optional<Eigen::Matrix2d> disagreementCovariance(const Rig& rig,
                                                      const Eigen::Vector3d& point,
                                                      std::size_t camera,
                                                      const std::size_t* others,
                                                      std::size_t count) {
  count = std::min(count, kMaximumOthers);
  std::array<PointJacobian, kMaximumOthers> point_by_others;
  const auto projection = rayProjection(rig, camera, point);
  if (!hasCovariance(rig) || !projection ||
      !pointSensitivity(rig, point, others, count, point_by_others.data()))
    return std::nullopt;
  std::array<ParameterJacobian, kMaximumOthers + 1> by_camera;
  std::array<std::size_t, kMaximumOthers + 1> cameras;
  for (std::size_t i = 0; i < count; ++i) {
    by_camera[i] = projection->by_point.lazyProduct(point_by_others[i]);
    cameras[i] = others[i];
  }
  by_camera[count] = projection->by_parameters;
  cameras[count] = camera;
  return propagatedErrors(rig.covariance, by_camera.data(), cameras.data(), count + 1);
}

std::optional<Eigen::MatrixXd> pointByParameters(const Rig& rig,
                                                 const Eigen::Vector3d& point,
                                                 const std::vector<std::size_t>& cameras,
                                                 const Eigen::Vector3d& velocity) {
  std::vector<PointJacobian> by_camera(cameras.size());
  if (!pointSensitivity(rig, point, cameras.data(), cameras.size(), by_camera.data(), velocity))
    return std::nullopt;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3, firstParameter(rig.cameras.size()));
  for (std::size_t i = 0; i < cameras.size(); ++i)
    result.middleCols<kParameters>(firstParameter(cameras[i])) = by_camera[i];
  return result;
}

std::vector<std::size_t> camerasSeeing(const Rig& rig, const Eigen::Vector3d& point) {
  std::vector<std::size_t> cameras;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (rig.rayCamera(rig.cameras[i]).sees(point))
      cameras.push_back(i);
  }
  return cameras;
}

}  // namespace wiimote_tracker::geometry
