#include "square/expected_error.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::square {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// RMS error of points by the rig's covariance [m]. @param by_parameters derivatives of their
/// coordinates by the rig's parameters, three rows a point
double rms(const Eigen::MatrixXd& by_parameters, const geometry::Rig& rig, std::size_t points) {
  return std::sqrt((by_parameters * rig.covariance).cwiseProduct(by_parameters).sum() /
                   static_cast<double>(points));
}

}  // namespace

Eigen::MatrixXd pointsByParameters(const geometry::Rig& rig, std::vector<Eigen::Vector3d>* points) {
  Eigen::MatrixXd result(3 * static_cast<Eigen::Index>(points->size()),
                         geometry::firstParameter(rig.cameras.size()));
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& point : *points) {
    if (const auto by_parameters =
            geometry::pointByParameters(rig, point, geometry::camerasSeeing(rig, point))) {
      result.middleRows<3>(3 * static_cast<Eigen::Index>(seen.size())) = *by_parameters;
      seen.push_back(point);
    }
  }
  *points = seen;
  return result.topRows(3 * static_cast<Eigen::Index>(seen.size()));
}

double expectedError(const geometry::Rig& rig, std::vector<Eigen::Vector3d> points) {
  if (!geometry::hasCovariance(rig))
    return kNan;
  const Eigen::MatrixXd errors = pointsByParameters(rig, &points);
  return rms(errors, rig, points.size());  // NaN of no points
}

double expectedShapeError(const geometry::Rig& rig, std::vector<Eigen::Vector3d> points) {
  if (!geometry::hasCovariance(rig))
    return kNan;
  const Eigen::MatrixXd errors = pointsByParameters(rig, &points);
  if (points.size() < 3)
    return kNan;
  Eigen::MatrixXd motions(errors.rows(), 6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto rows = motions.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    rows.leftCols<3>().setIdentity();
    rows.rightCols<3>() = geometry::so3::skew(points[i] - points.front());
  }
  const Eigen::MatrixXd basis = geometry::orthonormalBasis(motions);
  return rms(errors - basis * (basis.transpose() * errors), rig, points.size());
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
