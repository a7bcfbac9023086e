// Errors of a calibration by which one camera's spot disagrees with the others.
#include "geometry/random_rigs.h"
#include "geometry/uncertain_rigs.h"
#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

namespace wiimote_tracker::geometry {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using test::Random;

constexpr std::size_t kCamera = 1;
// Neither in order nor all.
const std::vector<std::size_t> kOthers = {3, 0};

std::optional<Matrix2d> disagreement(const Rig& rig,
                                     const Vector3d& point,
                                     const std::vector<std::size_t>& others = kOthers) {
  return disagreementCovariance(rig, point, kCamera, others.data(), others.size());
}

/// A rig of exact cameras.
Rig exactRig(Random& random, int cameras) {
  Rig rig = test::randomRig(random, cameras);
  const Eigen::Index size = firstParameter(rig.cameras.size());
  rig.covariance = MatrixXd::Zero(size, size);
  return rig;
}

TEST(Disagreement, IsTheSpreadOfSpotsOverRigsDrawnFromTheCovariance) {
  Random random(51);
  Rig rig = test::randomRig(random, 4);
  rig.covariance = test::randomCovariance(random, 4);
  const Vector3d point(0.3, -0.2, 0.4);
  const auto covariance = disagreement(rig, point);
  ASSERT_TRUE(covariance);
  // Small errors keep it linear; the spread is scaled back.
  constexpr double kSmall = 0.05;
  constexpr int kDraws = 4000;
  const test::ParameterErrors errors(rig.covariance);
  Matrix2d spread = Matrix2d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Rig truth = test::shifted(rig, kSmall * errors.draw(random));
    const Vector3d by_others = test::measured(rig, truth, kOthers, point);
    const Vector2d expected = *rig.cameras[kCamera].camera.project(by_others);
    const Vector2d spot = *truth.cameras[kCamera].camera.project(point);
    const Vector2d error = (spot - expected) / kSmall;
    spread += error * error.transpose() / kDraws;
  }
  // Within four standard errors.
  EXPECT_LT(test::whitenedDifference(spread, *covariance), 4.0 * std::sqrt(2.0 / kDraws) + 0.01);
}

TEST(Disagreement, OfAnErrorOfTheCameraAloneIsThatOfItsPixel) {
  Random random(52);
  Rig rig = exactRig(random, 4);
  // A principal point shifts all pixels of its camera.
  Matrix2d shift;
  shift << 4.0, 1.5, 1.5, 9.0;
  const Eigen::Index center = firstParameter(kCamera) + kIntrinsics + 2;
  rig.covariance.block<2, 2>(center, center) = shift;
  // That of a camera that is not asked does not matter.
  const Eigen::Index unasked = firstParameter(2) + kIntrinsics + 2;
  rig.covariance.block<2, 2>(unasked, unasked) = 100.0 * shift;
  const auto covariance = disagreement(rig, {0.1, 0.2, 0.3});
  ASSERT_TRUE(covariance);
  EXPECT_LT((*covariance - shift).norm(), 1e-9);
}

TEST(Disagreement, OfOthersThatShiftTogetherIsThatOfTheirPoint) {
  Random random(53);
  Rig rig = exactRig(random, 4);
  // A pinhole that looks at the point from a distance.
  constexpr double kFocal = 1300.0;
  constexpr double kDistance = 4.0;
  constexpr double kShift = 0.01;
  const Vector3d point(0.1, 0.2, 0.3);
  Camera& camera = rig.cameras[kCamera].camera;
  camera.intrinsics.fx = camera.intrinsics.fy = kFocal;
  camera.intrinsics.distortion = {};
  const Vector3d aside = Vector3d(-1.0, 2.0, 1.0).normalized();
  camera.world_from_camera = lookAt(point + kDistance * aside, point, Vector3d::UnitZ());
  for (const std::size_t i : kOthers) {
    for (const std::size_t j : kOthers)
      rig.covariance.block<3, 3>(firstParameter(i) + kPosition, firstParameter(j) + kPosition) =
          kShift * kShift * Matrix3d::Identity();
  }
  const auto covariance = disagreement(rig, point);
  ASSERT_TRUE(covariance);
  const double pixels = kFocal / kDistance * kShift;
  EXPECT_LT((*covariance / (pixels * pixels) - Matrix2d::Identity()).norm(), 1e-6);
}

TEST(Disagreement, ErrorsThatAllCamerasShareCancel) {
  // The whole rig is shifted, turned and scaled, which no pixel shows.
  Random random(54);
  Rig rig = exactRig(random, 4);
  MatrixXd by_similarity = MatrixXd::Zero(rig.covariance.rows(), 7);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Vector3d center = rig.cameras[i].camera.center();
    const Eigen::Index first = firstParameter(i);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d unit = Vector3d::Unit(axis);
      by_similarity.block<3, 1>(first + kPosition, axis) = unit;
      by_similarity.block<3, 1>(first + kRotation, 3 + axis) = unit;
      by_similarity.block<3, 1>(first + kPosition, 3 + axis) = unit.cross(center);
    }
    by_similarity.block<3, 1>(first + kPosition, 6) = center;
  }
  rig.covariance = 1e-4 * by_similarity * by_similarity.transpose();
  const Vector3d point(0.1, 0.2, 0.3);
  const auto shared = disagreement(rig, point);
  ASSERT_TRUE(shared);
  // The same errors, of each camera by itself, are seen.
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    for (std::size_t j = 0; j < rig.cameras.size(); ++j) {
      if (i != j)
        rig.covariance.block<kParameters, kParameters>(firstParameter(i), firstParameter(j))
            .setZero();
    }
  }
  const auto independent = disagreement(rig, point);
  ASSERT_TRUE(independent);
  EXPECT_GT(independent->determinant(), 1.0);
  EXPECT_LT(shared->norm(), 1e-6);
}

TEST(Disagreement, IsNothingWhereUnknown) {
  Random random(55);
  Rig rig = exactRig(random, 4);
  const Vector3d point = Vector3d::Zero();
  EXPECT_TRUE(disagreement(rig, point));
  EXPECT_FALSE(disagreement(rig, point, {0}));     // no point of one alone
  EXPECT_FALSE(disagreement(rig, point, {0, 0}));  // all at one place
  // Behind the camera, but before the others.
  Rig turned = rig;
  turned.cameras[kCamera].camera.world_from_camera.rotate(
      Eigen::AngleAxisd(M_PI, Vector3d::UnitX()));
  EXPECT_FALSE(disagreement(turned, point));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(disagreement(rig, {nan, 0.0, 0.0}));
  rig.covariance.resize(0, 0);
  EXPECT_FALSE(disagreement(rig, point));
}

TEST(Disagreement, OthersBeyondTheMostAreLeftOut) {
  Random random(56);
  constexpr int kCameras = static_cast<int>(kMaximumOthers) + 3;
  Rig rig = test::randomRig(random, kCameras);
  rig.covariance = test::randomCovariance(random, kCameras);
  std::vector<std::size_t> others(kMaximumOthers + 1);
  std::iota(others.begin(), others.end(), kCamera + 1);
  const auto of_all = disagreement(rig, Vector3d::Zero(), others);
  others.pop_back();
  const auto of_most = disagreement(rig, Vector3d::Zero(), others);
  ASSERT_TRUE(of_all && of_most);
  EXPECT_EQ(*of_all, *of_most);
}

}  // namespace
}  // namespace wiimote_tracker::geometry
