// From points and pixels to one pose.
#include "body/align.h"
#include "body/body_scene.h"
#include "body/match_points.h"
#include "body/solve_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::Random;
using test::boundOf;
using test::fourLeds;
using test::noise;
using test::normalisedError;
using test::randomPose;
using test::rotationError;

TEST(Align, IsThatOfUmeyama) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Isometry3d pose = randomPose(random, Vector3d::Zero());
    std::vector<PointPair> pairs;
    Eigen::Matrix3Xd from(3, 5);
    Eigen::Matrix3Xd to(3, 5);
    for (int i = 0; i < 5; ++i) {
      from.col(i) = random.inBox(0.2);
      to.col(i) = pose * Vector3d(from.col(i)) + noise(random, 0.02);
      pairs.push_back({from.col(i), to.col(i), 2.0});
    }
    const Eigen::Matrix4d expected = Eigen::umeyama(from, to, false);
    const Alignment alignment = align(pairs.data(), pairs.size());
    EXPECT_LT((alignment.world_from_body.matrix() - expected).norm(), 1e-9);
    EXPECT_NEAR(alignment.world_from_body.linear().determinant(), 1.0, 1e-9);
    EXPECT_NEAR(alignment.cost,
                2.0 * (to - ((expected.topLeftCorner<3, 3>() * from).colwise() +
                             expected.topRightCorner<3, 1>()))
                          .squaredNorm(),
                1e-9);
  }
}

TEST(Align, APairOfDoubleWeightEqualsTwoPairs) {
  Random random(4);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 4; ++i)
    pairs.push_back({random.inBox(0.2), random.inBox(0.2), 1.0 + i});
  std::vector<PointPair> twice = pairs;
  twice.push_back(twice[2]);
  pairs[2].weight *= 2.0;
  const Alignment heavy = align(pairs.data(), pairs.size());
  const Alignment repeated = align(twice.data(), twice.size());
  EXPECT_LT((heavy.world_from_body.matrix() - repeated.world_from_body.matrix()).norm(), 1e-12);
  EXPECT_NEAR(heavy.cost, repeated.cost, 1e-12);
}

std::size_t seenLeds(const Match& match) {
  const auto& points = match.point_of_led;
  return points.size() -
         static_cast<std::size_t>(std::count(points.begin(), points.end(), kUnseen));
}

TEST(MatchPoints, FindsTheBodyAmongOtherPoints) {
  Random random(5);
  int right = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Isometry3d pose = randomPose(random, {1.0, 1.0, 1.0});
    const bool one_hidden = trial % 2 == 1;
    std::vector<MeasuredPoint> points;
    std::vector<int> led_of_point;
    for (int i = 3; i >= (one_hidden ? 1 : 0); --i) {
      points.push_back({pose * fourLeds().leds[static_cast<std::size_t>(i)] + noise(random, 0.001),
                        0.002, false});
      led_of_point.push_back(i);
    }
    for (int i = 0; i < 3; ++i) {
      points.push_back({pose.translation() + random.inBox(0.5), 0.002, false});
      led_of_point.push_back(-1);
    }
    const auto match = matchPoints(fourLeds(), points);
    ASSERT_TRUE(match);
    bool good = seenLeds(*match) == (one_hidden ? 3u : 4u);
    for (int led = 0; led < 4; ++led) {
      const int p = match->point_of_led[static_cast<std::size_t>(led)];
      if (p != kUnseen)
        good = good && led_of_point[static_cast<std::size_t>(p)] == led;
    }
    right += good ? 1 : 0;
    if (good) {
      EXPECT_LT((match->world_from_body.translation() - pose.translation()).norm(), 0.02);
    }
  }
  // An LED that is not the body's may fit better than a noisy one that is.
  EXPECT_GE(right, 297);
}

TEST(MatchPoints, ReportsAmbiguity) {
  const Constellation isosceles{"a", {{-0.05, 0, 0}, {0.05, 0, 0}, {0, 0.2, 0}}};
  std::vector<MeasuredPoint> points;
  for (const Vector3d& led : isosceles.leds)
    points.push_back({led, 0.002, false});
  const auto match = matchPoints(isosceles, points);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->margin, 0.0, 1e-6);
  points[1].taken = true;
  EXPECT_FALSE(matchPoints(isosceles, points));
  EXPECT_FALSE(matchPoints(isosceles, {}));
}

TEST(MatchPoints, AMirroredBodyIsAnother) {
  std::vector<MeasuredPoint> points;
  for (const Vector3d& led : fourLeds().leds)
    points.push_back({led.cwiseProduct(Vector3d(1, 1, -1)), 0.002, false});
  const auto match = matchPoints(fourLeds(), points);
  ASSERT_TRUE(match);
  EXPECT_EQ(seenLeds(*match), 3u) << "though all distances agree";
}

TEST(SolvePose, ReachesTheBoundWithConsistentCovariance) {
  Random random(7);
  const geometry::Rig rig = tracking::test::paperRig();
  double squared = 0.0;
  double position = 0.0;
  double position_bound = 0.0;
  double rotation = 0.0;
  double rotation_bound = 0.0;
  double position_variance = 0.0;  // of the sums of squares
  double rotation_variance = 0.0;
  constexpr int kTrials = 1500;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Isometry3d truth = randomPose(random, {1.25, 1.25, 1.1});
    std::vector<LedObservation> observations;
    for (const geometry::RigCamera& camera : rig.cameras) {
      for (const Vector3d& led : fourLeds().leds) {
        const double u = 0.5 * random.gaussian();
        const double v = 0.5 * random.gaussian();
        if (camera.camera.sees(truth * led))
          observations.push_back(
              {&camera.camera, led, *camera.camera.project(truth * led) + Eigen::Vector2d(u, v)});
      }
    }
    Isometry3d start = truth;
    start.translation() += noise(random, 0.03);
    start.linear() =
        Eigen::AngleAxisd(0.3, random.inBox(1.0).normalized()).toRotationMatrix() * truth.linear();
    const auto solved = solvePose(observations.data(), observations.size(), start, 0.5);
    ASSERT_TRUE(solved);
    const PoseCovariance least = boundOf(rig, fourLeds(), truth, 0.5);
    EXPECT_LT((solved->covariance - least).norm(), 0.1 * least.norm());
    squared += normalisedError(truth, solved->world_from_body, solved->covariance);
    position += (solved->world_from_body.translation() - truth.translation()).squaredNorm();
    position_bound += least.topLeftCorner<3, 3>().trace();
    rotation += rotationError(truth, solved->world_from_body).squaredNorm();
    rotation_bound += least.bottomRightCorner<3, 3>().trace();
    position_variance += 2.0 * least.topLeftCorner<3, 3>().squaredNorm();
    rotation_variance += 2.0 * least.bottomRightCorner<3, 3>().squaredNorm();
  }
  EXPECT_NEAR(squared / (6.0 * kTrials), 1.0, 4.0 * std::sqrt(2.0 / (6.0 * kTrials)));
  EXPECT_NEAR(position / position_bound, 1.0, 4.0 * std::sqrt(position_variance) / position_bound);
  EXPECT_NEAR(rotation / rotation_bound, 1.0, 4.0 * std::sqrt(rotation_variance) / rotation_bound);
  RecordProperty("position_mm", std::to_string(1e3 * std::sqrt(position / kTrials)));
  RecordProperty("rotation_deg", std::to_string(std::sqrt(rotation / kTrials) * 180.0 / M_PI));
}

TEST(SolvePose, RefusesWhatDoesNotDetermineIt) {
  const geometry::Rig rig = tracking::test::paperRig();
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25, 1.25, 1.0);
  std::vector<LedObservation> observations;
  for (const geometry::RigCamera& camera : rig.cameras)
    observations.push_back(
        {&camera.camera, fourLeds().leds[0], *camera.camera.project(pose * fourLeds().leds[0])});
  EXPECT_FALSE(solvePose(observations.data(), 4, pose, 0.5)) << "one LED only";
  EXPECT_FALSE(solvePose(observations.data(), 2, pose, 0.5));
}

}  // namespace
}  // namespace wiimote_tracker::body
