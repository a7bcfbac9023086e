#include "predicted_accuracy.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace wiimote_tracker::session {

std::optional<Eigen::MatrixXd> pointByParameters(const geometry::Rig& rig,
                                                 const Eigen::Vector3d& point) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::MatrixXd by_parameters =
      Eigen::MatrixXd::Zero(3, geometry::firstParameter(rig.cameras.size()));
  int views = 0;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (!rig.rayCamera(rig.cameras[i]).sees(point))
      continue;
    const auto projection = geometry::rayProjection(rig, i, point);
    if (!projection)
      continue;
    ++views;
    information += projection->by_point.transpose() * projection->by_point;
    by_parameters.middleCols<geometry::kParameters>(geometry::firstParameter(i)) =
        -projection->by_point.transpose() * projection->by_parameters;
  }
  if (views < 2)
    return std::nullopt;
  const Eigen::MatrixXd result = information.inverse() * by_parameters;
  if (!result.allFinite())
    return std::nullopt;
  return result;
}

double predictedStddev(const geometry::Rig& rig, const Eigen::Vector3d& point) {
  const auto derivative =
      geometry::hasCovariance(rig) ? pointByParameters(rig, point) : std::nullopt;
  if (!derivative)
    return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt((*derivative * rig.covariance * derivative->transpose()).trace());
}

}  // namespace wiimote_tracker::session
