// The covariance of a body's pose holds the errors of the calibration.
#include "body/body_scene.h"
#include "body/pose_uncertainty.h"
#include "body/solve_pose.h"
#include "geometry/uncertain_rigs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::ParameterErrors;
using geometry::test::Random;
using geometry::test::shifted;
using test::fourLeds;
using tracking::test::paperRig;
using Vector6 = Eigen::Matrix<double, 6, 1>;

const Vector3d kMiddle(1.25, 1.25, 1.1);

/// At rest, all LEDs seen by these cameras.
BodyEstimate estimateAt(const Isometry3d& pose, const std::vector<std::size_t>& cameras) {
  BodyEstimate estimate;
  estimate.world_from_body = pose;
  for (const Vector3d& led : fourLeds().leds) {
    estimate.leds.emplace_back();
    estimate.leds.back().position = pose * led;
    estimate.leds.back().cameras = cameras;
  }
  return estimate;
}

/// The pose that cameras of the rig find in the pixels of the true ones.
Isometry3d solved(const geometry::Rig& rig,
                  const geometry::Rig& truth,
                  const std::vector<std::size_t>& cameras,
                  const Isometry3d& pose) {
  std::vector<LedObservation> observations;
  for (const std::size_t c : cameras) {
    for (const Vector3d& led : fourLeds().leds)
      observations.push_back(
          {&rig.cameras[c].camera, led, *truth.cameras[c].camera.project(pose * led)});
  }
  return solvePose(observations.data(), observations.size(), pose, 1e-6)->world_from_body;
}

TEST(CalibrationCovariance, IsTheSpreadOfPosesOverRigsDrawnFromTheCovariance) {
  Random random(51);
  geometry::Rig rig = paperRig();
  rig.covariance = geometry::test::randomCovariance(random, 4);
  const ParameterErrors errors(rig.covariance);
  // Small errors keep it linear; the spread is scaled back.
  constexpr double kSmall = 0.02;
  constexpr int kDraws = 1500;
  for (const std::vector<std::size_t>& cameras :
       {std::vector<std::size_t>{0, 1, 2, 3}, std::vector<std::size_t>{0, 2}}) {
    const Isometry3d pose = test::randomPose(random, kMiddle);
    const auto covariance = calibrationCovariance(rig, fourLeds(), estimateAt(pose, cameras));
    ASSERT_TRUE(covariance);
    PoseCovariance spread = PoseCovariance::Zero();
    for (int draw = 0; draw < kDraws; ++draw) {
      const Isometry3d found =
          solved(rig, shifted(rig, kSmall * errors.draw(random)), cameras, pose);
      Vector6 error;
      error << found.translation() - pose.translation(), test::rotationError(pose, found);
      spread += error * error.transpose() / (kSmall * kSmall * kDraws);
    }
    // Each element within four standard errors.
    EXPECT_LT(geometry::test::whitenedDifference(spread, *covariance),
              4.0 * std::sqrt(2.0 / kDraws) + 0.02);
  }
}

TEST(CalibrationCovariance, MakesTheTrackedPoseConsistent) {
  Random random(52);
  geometry::Rig rig = paperRig();
  rig.covariance = geometry::test::randomCovariance(random, 4, 0.1);
  const ParameterErrors errors(rig.covariance);
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  constexpr int kDraws = 60;
  double nees = 0.0, squares = 0.0, stated = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Isometry3d pose = test::randomPose(random, kMiddle);
    tracking::test::Scene scene(shifted(rig, errors.draw(random)),
                                test::pathsOf(fourLeds(), [&](double) { return pose; }), options,
                                static_cast<unsigned>(draw));
    BodyTracker tracker(rig, {fourLeds()}, BodyTrackerOptions());
    for (int i = 0; i < 160; ++i) {
      const tracking::test::SceneImage& image = scene.next();
      test::take(image, &tracker);
    }
    ASSERT_TRUE(tracker.bodies()[0]) << draw;
    const PoseCovariance covariance = tracker.bodies()[0]->covariance.topLeftCorner<6, 6>();
    const Isometry3d& found = tracker.bodies()[0]->world_from_body;
    nees += test::normalisedError(pose, found, covariance) / (6.0 * kDraws);
    squares += (found.translation() - pose.translation()).squaredNorm() / kDraws;
    stated += covariance.topLeftCorner<3, 3>().trace() / kDraws;
  }
  RecordProperty("nees", std::to_string(nees));
  RecordProperty("rms_mm", std::to_string(1e3 * std::sqrt(squares)));
  RecordProperty("stated_mm", std::to_string(1e3 * std::sqrt(stated)));
  // Three standard deviations of the mean of 360 are 0.22; of the noise alone it is about 0.8.
  EXPECT_GT(nees, 0.6);
  EXPECT_LT(nees, 1.25);
}

TEST(CalibrationCovariance, HoldsErrorsOfTheClocksOfAMovingBody) {
  geometry::Rig rig = paperRig();
  rig.covariance = Eigen::MatrixXd::Zero(64, 64);
  constexpr double kClock = 1e-3;  // [s], common to all cameras
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b)
      rig.covariance(geometry::firstParameter(a) + geometry::kTimeOffset,
                     geometry::firstParameter(b) + geometry::kTimeOffset) = kClock * kClock;
  }
  BodyEstimate estimate = estimateAt(Isometry3d(Eigen::Translation3d(kMiddle)), {0, 1, 2, 3});
  estimate.velocity = {2.0, 0.0, 0.0};
  estimate.angular_velocity = {0.0, 3.0, 0.0};
  Vector6 shift;
  shift << kClock * estimate.velocity, kClock * estimate.angular_velocity;
  const auto covariance = calibrationCovariance(rig, fourLeds(), estimate);
  ASSERT_TRUE(covariance);
  EXPECT_LT((*covariance - shift * shift.transpose()).norm(), 1e-3 * shift.squaredNorm());
}

TEST(CalibrationCovariance, IsThatOfAllCamerasInViewWhileTheBodyIsHidden) {
  Random random(53);
  geometry::Rig rig = paperRig();
  rig.covariance = geometry::test::randomCovariance(random, 4);
  const Isometry3d pose(Eigen::Translation3d{kMiddle});
  const auto seen = calibrationCovariance(rig, fourLeds(), estimateAt(pose, {0, 1, 2, 3}));
  const auto hidden = calibrationCovariance(rig, fourLeds(), estimateAt(pose, {}));
  ASSERT_TRUE(seen && hidden);
  EXPECT_EQ(*seen, *hidden);
  const Isometry3d behind(Eigen::Translation3d(0.0, 0.0, 100.0));
  EXPECT_FALSE(calibrationCovariance(rig, fourLeds(), estimateAt(behind, {})));
  rig.covariance.resize(0, 0);
  EXPECT_FALSE(calibrationCovariance(rig, fourLeds(), estimateAt(pose, {0, 1, 2, 3})));
}

}  // namespace
}  // namespace wiimote_tracker::body
