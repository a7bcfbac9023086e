#include "predicted_error.h"

#include "projection.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>
#include <limits>

namespace wiimote_tracker::wave {

PredictedError predictedError(const std::vector<geometry::Camera>& cameras,
                              const Eigen::MatrixXd& covariance,
                              const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Index parameters = covariance.cols();
  // Errors of the points from errors of the cameras' parameters.
  Eigen::MatrixXd errors(3 * static_cast<Eigen::Index>(points.size()), parameters);
  Eigen::MatrixXd motions(errors.rows(), 6);
  Eigen::Index rows = 0;
  for (const Eigen::Vector3d& point : points) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3, parameters);
    int views = 0;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      Projection projection;
      if (!cameras[i].sees(point) || !project(cameras[i], point, &projection))
        continue;
      ++views;
      information += projection.by_point.transpose() * projection.by_point;
      right.middleCols<kCameraSize>(kCameraSize * static_cast<Eigen::Index>(i)) =
          projection.by_point.transpose() * projection.by_camera;
    }
    if (views < 2)
      continue;
    errors.middleRows<3>(rows) = -information.inverse() * right;
    motions.block<3, 3>(rows, 0).setIdentity();
    motions.block<3, 3>(rows, 3) = crossMatrix(point - points.front());
    rows += 3;
  }
  const double count = static_cast<double>(rows) / 3.0;
  // Three points at least have a shape.
  if (rows < 9 || !errors.topRows(rows).allFinite()) {
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
