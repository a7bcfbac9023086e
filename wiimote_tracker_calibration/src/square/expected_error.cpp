#include "square/expected_error.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::square {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// How a point moves with the rig's parameters; nothing when it does not count.
std::optional<Eigen::MatrixXd> sensitivityOf(const geometry::Rig& rig,
                                             const Eigen::Vector3d& point) {
  if (!geometry::hasCovariance(rig))
    return std::nullopt;
  return geometry::pointByParameters(rig, point, geometry::camerasSeeing(rig, point));
}

}  // namespace

double expectedError(const geometry::Rig& rig, const std::vector<Eigen::Vector3d>& points) {
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Vector3d& point : points) {
    const auto by_parameters = sensitivityOf(rig, point);
    if (!by_parameters)
      continue;
    ++count;
    sum += geometry::propagated(*by_parameters, rig.covariance).trace();
  }
  return count > 0 ? std::sqrt(sum / count) : kNan;
}

double expectedShapeError(const geometry::Rig& rig, const std::vector<Eigen::Vector3d>& points) {
  Eigen::MatrixXd errors(3 * static_cast<Eigen::Index>(points.size()), rig.covariance.cols());
  Eigen::MatrixXd motions(errors.rows(), 6);
  Eigen::Index rows = 0;
  for (const Eigen::Vector3d& point : points) {
    const auto by_parameters = sensitivityOf(rig, point);
    if (!by_parameters)
      continue;
    errors.middleRows<3>(rows) = *by_parameters;
    motions.block<3, 3>(rows, 0).setIdentity();
    motions.block<3, 3>(rows, 3) = geometry::so3::skew(point - points.front());
    rows += 3;
  }
  if (rows < 9)
    return kNan;
  const Eigen::MatrixXd all = errors.topRows(rows);
  const Eigen::MatrixXd basis = geometry::orthonormalBasis(motions.topRows(rows));
  const Eigen::MatrixXd shape = all - basis * (basis.transpose() * all);
  return std::sqrt((shape * rig.covariance).cwiseProduct(shape).sum() /
                   (static_cast<double>(rows) / 3.0));
}

std::vector<Eigen::Vector3d> boxOver(const std::array<Eigen::Vector3d, 4>& corners, bool z_up) {
  const double height =
      std::min((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm());
  const Eigen::Vector3d up(0.0, 0.0, z_up ? height : -height);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& corner : corners) {
    points.push_back(corner);
    points.push_back(corner + up);
  }
  points.push_back(0.5 * (corners[0] + corners[2] + up));
  return points;
}

}  // namespace wiimote_tracker::square
