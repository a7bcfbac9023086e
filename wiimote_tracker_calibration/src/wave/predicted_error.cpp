#include "predicted_error.h"

#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/QR>

#include <cmath>
#include <limits>

namespace wiimote_tracker::wave {

PredictedError predictedError(const geometry::Rig& rig,
                              const std::vector<Eigen::Vector3d>& points) {
  const Eigen::MatrixXd& covariance = rig.covariance;
  // Errors of the points from errors of the cameras' parameters.
  Eigen::MatrixXd errors(3 * static_cast<Eigen::Index>(points.size()), covariance.cols());
  Eigen::MatrixXd motions(errors.rows(), 6);
  Eigen::Index rows = 0;
  for (const Eigen::Vector3d& point : points) {
    const auto by_parameters =
        geometry::pointByParameters(rig, point, geometry::camerasSeeing(rig, point));
    if (!by_parameters)
      continue;
    errors.middleRows<3>(rows) = *by_parameters;
    motions.block<3, 3>(rows, 0).setIdentity();
    motions.block<3, 3>(rows, 3) = geometry::so3::skew(point - points.front());
    rows += 3;
  }
  const double count = static_cast<double>(rows) / 3.0;
  // Three points at least have a shape.
  if (rows < 9) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  const Eigen::MatrixXd all = errors.topRows(rows);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(motions.topRows(rows));
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(rows, 6);
  const Eigen::MatrixXd shape = all - basis * (basis.transpose() * all);
  return {std::sqrt((all * covariance).cwiseProduct(all).sum() / count),
          std::sqrt((shape * covariance).cwiseProduct(shape).sum() / count)};
}

}  // namespace wiimote_tracker::wave
