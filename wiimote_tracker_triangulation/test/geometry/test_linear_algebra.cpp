#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <limits>
#include <random>
#include <vector>

namespace wiimote_tracker::geometry {
namespace {

class LinearAlgebra : public ::testing::Test {
 protected:
  Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random_); });
  }

  Eigen::MatrixXd randomCovariance(Eigen::Index size) {
    const Eigen::MatrixXd root = random(size, size);
    return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size);
  }

  std::mt19937 random_{1};
};

TEST_F(LinearAlgebra, PropagatesACovarianceSymmetrically) {
  const Eigen::MatrixXd jacobian = random(4, 7);
  const Eigen::MatrixXd covariance = randomCovariance(7);
  const Eigen::MatrixXd result = propagated(jacobian, covariance);
  EXPECT_TRUE(result.isApprox(jacobian * covariance * jacobian.transpose(), 1e-12));
  EXPECT_EQ(result, result.transpose());
}

TEST_F(LinearAlgebra, MahalanobisDistanceCountsStandardDeviations) {
  EXPECT_DOUBLE_EQ(4.0 + 9.0,
                   squaredMahalanobis(Eigen::Vector2d(2.0, 30.0),
                                      Eigen::Vector2d(1.0, 100.0).asDiagonal().toDenseMatrix()));
  const Eigen::VectorXd error = random(6, 1);
  const Eigen::MatrixXd covariance = randomCovariance(6);
  EXPECT_NEAR(error.dot(covariance.inverse() * error), squaredMahalanobis(error, covariance), 1e-9);
}

TEST_F(LinearAlgebra, SolvesSymmetricSystems) {
  const Eigen::MatrixXd matrix = randomCovariance(5);
  const Eigen::MatrixXd expected = random(5, 2);
  EXPECT_TRUE(solveSymmetric(matrix, matrix * expected).isApprox(expected, 1e-9));
}

TEST_F(LinearAlgebra, PseudoInverseSolvesLeastSquares) {
  const Eigen::MatrixXd matrix = random(9, 4);
  const Eigen::VectorXd right = random(9, 1);
  const Eigen::VectorXd solution = pseudoInverse(matrix) * right;
  // What is left is orthogonal to every column.
  EXPECT_LT((matrix.transpose() * (right - matrix * solution)).norm(), 1e-12);
  // Of a matrix without full rank: the shortest solution.
  const Eigen::MatrixXd twice = (Eigen::MatrixXd(2, 2) << 1.0, 1.0, 1.0, 1.0).finished();
  EXPECT_TRUE(
      (pseudoInverse(twice) * Eigen::Vector2d(2.0, 2.0)).isApprox(Eigen::Vector2d(1.0, 1.0)));
}

TEST_F(LinearAlgebra, BasisIsOrthonormalAndSpansTheColumns) {
  const Eigen::MatrixXd columns = random(8, 3);
  const Eigen::MatrixXd basis = orthonormalBasis(columns);
  ASSERT_EQ(3, basis.cols());
  EXPECT_TRUE((basis.transpose() * basis).isIdentity(1e-12));
  EXPECT_TRUE((basis * (basis.transpose() * columns)).isApprox(columns, 1e-12));
}

TEST_F(LinearAlgebra, InvertsInformationOfVeryDifferentUnits) {
  const Eigen::VectorXd units = (Eigen::VectorXd(4) << 1e-8, 1.0, 1e6, 1e9).finished();
  const Eigen::MatrixXd plain = randomCovariance(4);
  const auto inverse = inverseOfInformation(units.asDiagonal() * plain * units.asDiagonal());
  ASSERT_TRUE(inverse);
  EXPECT_TRUE((units.asDiagonal() * *inverse * units.asDiagonal())
                  .isApprox(Eigen::MatrixXd(plain.inverse()), 1e-9));
}

TEST_F(LinearAlgebra, HasNoInverseOfSingularInformation) {
  const Eigen::MatrixXd rows = random(3, 4);
  EXPECT_FALSE(inverseOfInformation(rows.transpose() * rows));
  EXPECT_FALSE(inverseOfInformation(Eigen::Matrix2d::Zero()));
  EXPECT_FALSE(
      inverseOfInformation(Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST_F(LinearAlgebra, SpreadIsThatOfTheAxes) {
  // The corners of a box: half of an edge is the standard deviation along it.
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  std::vector<Eigen::Vector3d> points;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-2.0, 2.0}) {
      for (const double z : {-0.5, 0.5})
        points.push_back(turn * Eigen::Vector3d(x, y, z) + Eigen::Vector3d(10.0, 20.0, 30.0));
    }
  }
  EXPECT_TRUE(spreadOf(points).isApprox(Eigen::Vector3d(2.0, 1.0, 0.5), 1e-9));
  points.back().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(spreadOf(points).array().isNaN().all());
}

TEST_F(LinearAlgebra, PointsOnALineHaveNoSecondSpread) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 20; ++i)
    points.push_back(i * Eigen::Vector3d(0.1, 0.2, 0.3) + Eigen::Vector3d(3.0, 2.0, 1.0));
  const Eigen::Vector3d spread = spreadOf(points);
  EXPECT_LT(spread[1], 1e-7 * spread[0]);
}

}  // namespace
}  // namespace wiimote_tracker::geometry
