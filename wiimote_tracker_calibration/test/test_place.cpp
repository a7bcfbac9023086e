// A still LED measured with rigs whose errors are known.

#include "expect_says.h"
#include "refusal_of.h"
#include "simulated_rig.h"

#include "place/check_place.h"
#include "place/measure_place.h"

#include <wiimote_tracker_msgs/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wiimote_tracker::place {
namespace {

using square::normal;
using square::Random;
using square::uniform;

constexpr double kPixel = 0.2;

Eigen::Vector3d somewhere(Random& random) {
  return {uniform(random, 0.3, 2.2), uniform(random, 0.3, 2.2), uniform(random, 0.1, 2.0)};
}

/// What the true cameras see of an LED.
capture::CapturedCorner seen(const std::vector<geometry::RigCamera>& truth,
                             const Eigen::Vector3d& led,
                             double noise,
                             Random& random) {
  capture::CapturedCorner corner;
  for (const geometry::RigCamera& camera : truth) {
    const Eigen::Vector2d error(normal(random, noise), normal(random, noise));
    corner[camera.camera.name] = {camera.camera.project(led).value() + error, 0.3, 50};
  }
  return corner;
}

std::string refusal(const geometry::Rig& rig, const capture::CapturedCorner& corner) {
  return refusalOf([&] { measurePlace(rig, corner, kPixel); });
}

TEST(CameraParameters, DerivativesAreThoseOfDisplacedCamerasForEveryLens) {
  Random random(1);
  geometry::Rig rig = paperRigWith({});
  geometry::RigCamera camera = rig.cameras[1];
  geometry::Intrinsics& lens = camera.camera.intrinsics;
  for (const auto model : geometry::kDistortionModels) {
    SCOPED_TRACE(geometry::nameOf(model));
    lens.distortion_model = model;
    lens.distortion = {-0.1, 0.02, 0.003, -0.002, 0.01};
    for (std::size_t k = geometry::coefficientCount(model); k < lens.distortion.size(); ++k)
      lens.distortion[k] = 0.0;
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector3d point = somewhere(random);
      const auto projection = geometry::projectionOf(camera.camera, point);
      ASSERT_TRUE(projection);
      EXPECT_LT((projection->pixel - camera.camera.project(point).value()).norm(), 1e-9);
      for (Eigen::Index k = 0; k < geometry::kTimeOffset; ++k) {
        const double step = 1e-5;
        const Eigen::VectorXd delta = step * Eigen::VectorXd::Unit(geometry::kParameters, k);
        const Eigen::Vector2d difference =
            (displaced(camera, delta).camera.project(point).value() -
             displaced(camera, -delta).camera.project(point).value()) /
            (2.0 * step);
        EXPECT_LT((difference - projection->by_parameters.col(k)).norm(),
                  1e-4 * std::max(1.0, difference.norm()))
            << k;
      }
      EXPECT_EQ(projection->by_parameters.col(geometry::kTimeOffset).norm(), 0.0);
    }
  }
}

TEST(CameraParameters, ParametersSetByTheRayModelHaveNoUncertainty) {
  geometry::Rig rig = paperRigWith({});
  rig.ray_model = geometry::RayModel::kImageCenter;
  const Eigen::Vector3d point(1.0, 1.2, 1.0);
  auto projection = geometry::rayProjection(rig, 0, point);
  ASSERT_TRUE(projection);
  EXPECT_GT(projection->by_parameters.col(geometry::kIntrinsics).norm(), 0.0);
  EXPECT_EQ(projection->by_parameters.rightCols<8>().norm(), 0.0);
  rig.virtual_hfov = 0.7;
  projection = geometry::rayProjection(rig, 0, point);
  ASSERT_TRUE(projection);
  EXPECT_EQ(projection->by_parameters.col(geometry::kIntrinsics).norm(), 0.0);
  EXPECT_GT(projection->by_parameters.col(geometry::kPosition).norm(), 0.0);
}

TEST(MeasurePlace, IsExactWithoutErrors) {
  Random random(2);
  const geometry::Rig rig = paperRigWith({});
  const Eigen::Vector3d led(1.0, 0.7, 0.4);
  const MeasuredPlace place = measurePlace(rig, seen(rig.cameras, led, 0.0, random), kPixel);
  EXPECT_LT((place.position - led).norm(), 1e-9);
  EXPECT_TRUE(place.rays_agree);
  ASSERT_EQ(place.residuals.size(), 4u);
  EXPECT_EQ(place.residuals[2].camera, "camera_3");
  EXPECT_LT(place.residuals[2].residual.norm(), 1e-6);
}

TEST(MeasurePlace, CamerasThatMoveTogetherMoveThePoint) {
  Random random(3);
  geometry::Rig rig = paperRigWith({});
  const Eigen::Vector3d led(1.0, 0.7, 0.4);
  const capture::CapturedCorner corner = seen(rig.cameras, led, 0.0, random);
  rig.covariance.setZero();
  const Eigen::Matrix3d pixels_only = measurePlace(rig, corner, kPixel).covariance;
  const Eigen::Matrix3d common = Eigen::Vector3d(1e-4, 4e-4, 9e-4).asDiagonal();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j)
      rig.covariance.block<3, 3>(geometry::firstParameter(i) + geometry::kPosition,
                                 geometry::firstParameter(j) + geometry::kPosition) = common;
  }
  const MeasuredPlace place = measurePlace(rig, corner, kPixel);
  EXPECT_LT((place.covariance - pixels_only - common).norm(), 1e-12);
}

// Of many checks with a right calibration, 1 % at most ought to find fault with it.
TEST(CheckPlace, HasTheStatedCoverage) {
  Random random(4);
  const int kTrials = 3000;
  const double kPlacement = 0.003;
  int all_disagreeing = 0;
  for (const std::size_t cameras : {2u, 4u}) {
    const geometry::Rig rig = paperRigWith({}, cameras);
    int inconsistent = 0;
    int disagreeing = 0;
    double squared = 0.0;
    double expected = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto truth = drawTruth(rig, random);
      const Eigen::Vector3d known = somewhere(random);
      const Eigen::Vector3d led =
          known + Eigen::Vector3d(normal(random, kPlacement), normal(random, kPlacement),
                                  normal(random, kPlacement));
      const MeasuredPlace place = measurePlace(rig, seen(truth, led, kPixel, random), kPixel);
      const PlaceCheck check = checkPlace(place, known, kPlacement);
      inconsistent += !check.consistent;
      disagreeing += !place.rays_agree;
      squared += check.error * check.error;
      expected += check.expected_stddev * check.expected_stddev;
    }
    // Binomial: 1 % of 3000 is 30 +- 5.4, 0.1 % is 3 +- 1.7.
    EXPECT_GE(inconsistent, 12);
    EXPECT_LE(inconsistent, 50);
    EXPECT_LE(disagreeing, 10);
    all_disagreeing += disagreeing;
    EXPECT_NEAR(squared / expected, 1.0, 0.1);
  }
  // 6 +- 2.4.
  EXPECT_GE(all_disagreeing, 1);
}

TEST(CheckPlace, NamesTheCameraThatWasMoved) {
  Random random(5);
  const geometry::Rig rig = paperRigWith({});
  int alone = 0;
  for (int trial = 0; trial < 200; ++trial) {
    auto truth = drawTruth(rig, random);
    const std::size_t moved = static_cast<std::size_t>(trial) % 4;
    const std::string& name = truth[moved].camera.name;
    Eigen::VectorXd turn = Eigen::VectorXd::Zero(geometry::kParameters);
    // About the vertical, and a little downwards: of a turn about the vertical alone the camera
    // on the other side may be accused as well.
    turn.segment<3>(geometry::kRotation) =
        Eigen::Vector3d(0.0, 0.0, 2.0) * M_PI / 180.0 +
        0.03 * truth[moved].camera.world_from_camera.linear().col(0);
    truth[moved] = displaced(truth[moved], turn);
    const Eigen::Vector3d led = somewhere(random);
    const MeasuredPlace place = measurePlace(rig, seen(truth, led, kPixel, random), kPixel);
    EXPECT_FALSE(place.rays_agree);
    EXPECT_EQ(std::count(place.suspects.begin(), place.suspects.end(), name), 1);
    alone += place.suspects.size() == 1;
    EXPECT_SAYS(checkPlace(place, led, 0.003).message, name);
  }
  EXPECT_GE(alone, 150);
}

TEST(CheckPlace, StatesErrorAndExpectedError) {
  Random random(6);
  geometry::Rig rig = paperRigWith({});
  const Eigen::Vector3d led(1.0, 0.7, 0.4);
  const capture::CapturedCorner corner = seen(rig.cameras, led, 0.0, random);
  PlaceCheck check = checkPlace(measurePlace(rig, corner, kPixel), led, 0.0);
  EXPECT_TRUE(check.consistent);
  EXPECT_SAYS(check.message, "holds");

  const Eigen::Vector3d wrong = led + Eigen::Vector3d(0.0, 0.1, 0.0);
  check = checkPlace(measurePlace(rig, corner, kPixel), wrong, 0.0);
  EXPECT_FALSE(check.consistent);
  EXPECT_NEAR(check.error, 0.1, 1e-6);
  EXPECT_SAYS(check.message, "100.0 mm");
  EXPECT_SAYS(check.message, "too much: check the place");
  EXPECT_TRUE(checkPlace(measurePlace(rig, corner, kPixel), wrong, 0.1).consistent);

  rig.covariance.resize(0, 0);
  const MeasuredPlace place = measurePlace(rig, corner, kPixel);
  EXPECT_FALSE(place.calibration_known);
  EXPECT_SAYS(checkPlace(place, wrong, 0.0).message, "only the pixels");

  EXPECT_THROW(requirePlace(led, -1.0), Error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(requirePlace({nan, 0.0, 0.0}, 0.0), Error);
}

// A correction that moves all points up by 50 mm; one of another calibration does nothing.
TEST(MeasurePlace, IsCorrectedAsTheTrackerDoesIt) {
  Random random(8);
  geometry::Rig rig = paperRigWith({});
  const Eigen::Vector3d led(1.0, 0.7, 0.4);
  const MeasuredPlace place = measurePlace(rig, seen(rig.cameras, led, 0.0, random), kPixel);
  EXPECT_EQ(corrected(rig, place).position, place.position);
  remap::Remap correction;
  correction.rig_id = rig.id();
  correction.parameters.assign(12, 0.0);
  correction.parameters[2] = 0.05;
  for (const double x : {0.0, 2.5}) {
    for (const double y : {0.0, 2.5}) {
      for (const double z : {0.0, 2.5})
        correction.support.emplace_back(x, y, z);
    }
  }
  rig.remap = correction;
  EXPECT_LT((corrected(rig, place).position - led - Eigen::Vector3d(0.0, 0.0, 0.05)).norm(), 1e-6);
  rig.remap->rig_id = "another";
  EXPECT_EQ(corrected(rig, place).position, place.position);
}

TEST(MeasurePlace, RefusesWhatDoesNotDetermineAPoint) {
  Random random(7);
  const geometry::Rig rig = paperRigWith({});
  const Eigen::Vector3d led(1.0, 0.7, 0.4);
  const capture::CapturedCorner all = seen(rig.cameras, led, 0.0, random);
  EXPECT_SAYS(refusal(rig, {}), "no camera");
  EXPECT_SAYS(refusal(rig, {{"camera_1", all.at("camera_1")}}), "camera_1 alone");
  // A camera of another rig is no camera.
  EXPECT_SAYS(refusal(rig, {{"camera_1", all.at("camera_1")}, {"other", all.at("camera_2")}}),
              "camera_1 alone");
  geometry::Rig twice = rig;
  twice.cameras[1].camera.world_from_camera = twice.cameras[0].camera.world_from_camera;
  EXPECT_SAYS(refusal(twice, {{"camera_1", all.at("camera_1")}, {"camera_2", all.at("camera_1")}}),
              "parallel");
}

}  // namespace
}  // namespace wiimote_tracker::place
