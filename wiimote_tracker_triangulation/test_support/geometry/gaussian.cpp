#include "geometry/gaussian.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace wiimote_tracker::geometry::test {

Eigen::MatrixXd rootOf(const AnyMatrix& covariance) {
  return Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL();
}

double whitenedDifference(const AnyMatrix& spread, const AnyMatrix& covariance) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(spread.rows(), spread.cols());
  const Eigen::MatrixXd whiten = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL().solve(one);
  return (propagated(whiten, spread) - one).cwiseAbs().maxCoeff();
}

double leastEigenvalue(const AnyMatrix& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
}

}  // namespace wiimote_tracker::geometry::test
