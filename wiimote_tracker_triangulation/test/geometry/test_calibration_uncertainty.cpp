#include "geometry/random_rigs.h"
#include "geometry/uncertain_rigs.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wiimote_tracker::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using test::Random;

constexpr Eigen::Index kPerCamera = 16;
constexpr std::size_t kAll[] = {0, 1, 2, 3};

Rig uncertainRig(Random& random) {
  Rig rig = test::randomRig(random, 4);
  rig.covariance = test::randomCovariance(random, 4);
  return rig;
}

TEST(CalibrationUncertainty, IsTheSpreadOfPointsOverRigsDrawnFromTheCovariance) {
  Random random(41);
  const Rig rig = uncertainRig(random);
  const Vector3d point(0.3, -0.2, 0.4);
  const CalibrationUncertainty uncertainty(rig);
  const auto covariance = uncertainty.covarianceOf(point, kAll, 4);
  ASSERT_TRUE(covariance);
  // Small errors keep it linear; the spread is scaled back.
  constexpr double kSmall = 0.05;
  constexpr int kDraws = 4000;
  const test::ParameterErrors errors(rig.covariance);
  Matrix3d spread = Matrix3d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Rig truth = test::shifted(rig, kSmall * errors.draw(random));
    const Vector3d error = (test::measured(rig, truth, {0, 1, 2, 3}, point) - point) / kSmall;
    spread += error * error.transpose() / kDraws;
  }
  // Within four standard errors.
  EXPECT_LT(test::whitenedDifference(spread, *covariance), 4.0 * std::sqrt(2.0 / kDraws) + 0.01);
}

TEST(CalibrationUncertainty, IsSystematic) {
  // All cameras shift together, so the point shifts with them, however many there are.
  Random random(42);
  Rig rig = test::randomRig(random, 4);
  constexpr double kShift = 0.01;
  rig.covariance = MatrixXd::Zero(4 * kPerCamera, 4 * kPerCamera);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b)
      rig.covariance.block<3, 3>(kPerCamera * a + 3, kPerCamera * b + 3) =
          kShift * kShift * Matrix3d::Identity();
  }
  const CalibrationUncertainty uncertainty(rig);
  for (const std::size_t count : {2u, 3u, 4u}) {
    const auto covariance = uncertainty.covarianceOf({0.1, 0.2, 0.3}, kAll, count);
    ASSERT_TRUE(covariance);
    EXPECT_LT((*covariance / (kShift * kShift) - Matrix3d::Identity()).norm(), 1e-6) << count;
  }
}

TEST(CalibrationUncertainty, NearIsTheCovarianceOfTheCell) {
  Random random(43);
  const Rig rig = uncertainRig(random);
  CalibrationUncertainty uncertainty(rig);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {  // more than the cache holds
    const Vector3d point = random.inBox(1.0);
    const std::size_t count = 2 + static_cast<std::size_t>(i) % 3;
    const Vector3d middle = 0.2 * ((point / 0.2).array().floor() + 0.5).matrix();
    const auto exact = uncertainty.covarianceOf(middle, kAll, count);
    const auto near = uncertainty.covarianceNear(point, kAll, count);
    ASSERT_EQ(exact.has_value(), near.has_value());
    if (exact) {
      ASSERT_LT((*exact - *near).norm(), 1e-9 * exact->norm());
      ++compared;
    }
  }
  EXPECT_GT(compared, 1500);
}

TEST(CalibrationUncertainty, IsNothingWhereUnknown) {
  Random random(44);
  Rig rig = uncertainRig(random);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  {
    CalibrationUncertainty uncertainty(rig);
    EXPECT_FALSE(uncertainty.covarianceOf({0.0, 0.0, 0.0}, kAll, 1));
    EXPECT_FALSE(uncertainty.covarianceNear({nan, 0.0, 0.0}, kAll, 4));
    EXPECT_FALSE(uncertainty.covarianceOf({0.0, 0.0, 1000.0}, kAll, 4));  // behind a camera
    const std::size_t same[] = {0, 0};
    EXPECT_FALSE(uncertainty.covarianceOf({0.0, 0.0, 0.0}, same, 2));
  }
  rig.covariance.resize(0, 0);
  CalibrationUncertainty uncertainty(rig);
  EXPECT_FALSE(uncertainty.covarianceOf({0.0, 0.0, 0.0}, kAll, 4));
  EXPECT_FALSE(uncertainty.covarianceNear({0.0, 0.0, 0.0}, kAll, 4));
}

}  // namespace
}  // namespace wiimote_tracker::geometry
