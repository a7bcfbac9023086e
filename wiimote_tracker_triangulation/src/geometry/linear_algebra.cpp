#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <limits>

namespace wiimote_tracker::geometry {

Eigen::MatrixXd propagated(const AnyMatrix& jacobian, const AnyMatrix& covariance) {
  const Eigen::MatrixXd product = jacobian * covariance * jacobian.transpose();
  return 0.5 * (product + product.transpose());
}

double squaredMahalanobis(const AnyVector& error, const AnyMatrix& covariance) {
  return error.dot(Eigen::LDLT<Eigen::MatrixXd>(covariance).solve(error));
}

Eigen::MatrixXd solveSymmetric(const AnyMatrix& matrix, const AnyMatrix& right) {
  return Eigen::LDLT<Eigen::MatrixXd>(matrix).solve(right);
}

Eigen::MatrixXd pseudoInverse(const AnyMatrix& matrix) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(matrix).pseudoInverse();
}

Eigen::MatrixXd orthonormalBasis(const AnyMatrix& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

std::optional<Eigen::MatrixXd> inverseOfInformation(const AnyMatrix& information) {
  constexpr double kSingular = 1e-13;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite())
    return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information *
                                                             scale.asDiagonal());
  if (eigen.info() != Eigen::Success ||
      !(eigen.eigenvalues().minCoeff() > kSingular * eigen.eigenvalues().maxCoeff()))
    return std::nullopt;
  const Eigen::MatrixXd root = scale.asDiagonal() * eigen.eigenvectors() *
                               eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
  return Eigen::MatrixXd(root * root.transpose());
}

Eigen::Vector3d spreadOf(const std::vector<Eigen::Vector3d>& points) {
  const auto count = static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
    mean += point / count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points)
    scatter += (point - mean) * (point - mean).transpose() / count;
  if (!scatter.allFinite())
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter, Eigen::EigenvaluesOnly);
  return axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
}

Eigen::Isometry3d rigidAlignment(const std::vector<Eigen::Vector3d>& in_a,
                                 const std::vector<Eigen::Vector3d>& in_b) {
  using Columns = Eigen::Map<const Eigen::Matrix3Xd>;
  const auto count = static_cast<Eigen::Index>(in_a.size());
  return Eigen::Isometry3d(Eigen::umeyama(Columns(in_b.front().data(), 3, count),
                                          Columns(in_a.front().data(), 3, count), false));
}

}  // namespace wiimote_tracker::geometry
