// Following bodies image by image: accuracy and special cases.
#include "body/body_scene.h"
#include "body/body_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::Random;
using test::BodyScore;
using test::FollowedBody;
using test::fourLeds;
using test::handheld;
using test::pathsOf;
using test::randomPose;
using test::rotationError;
using test::tumbling;
using tracking::test::paperRig;

tracking::test::SceneOptions halfAPixel() {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  return options;
}

/// Of so many seconds after the first one.
BodyScore score(FollowedBody* follow, double seconds) {
  constexpr double kBegin = 1001.0;
  BodyScore score;
  while (follow->time() < kBegin + seconds) {
    follow->step();
    if (follow->time() >= kBegin)
      score.add(*follow);
  }
  return score;
}

void record(const BodyScore& score) {
  testing::Test::RecordProperty("position_ratio", std::to_string(score.positionRatio()));
  testing::Test::RecordProperty("rotation_ratio", std::to_string(score.rotationRatio()));
  testing::Test::RecordProperty("nees", std::to_string(score.nees()));
}

TEST(BodyTracker, FollowsAHandWithinTheBoundOfASingleView) {
  FollowedBody follow(paperRig(), fourLeds(), handheld, halfAPixel(), 21);
  const BodyScore result = score(&follow, 8.0);
  EXPECT_EQ(result.known(), 1.0);
  EXPECT_EQ(result.wrong(), 0.0);
  EXPECT_LT(result.positionRatio(), 1.1);
  EXPECT_LT(result.rotationRatio(), 1.1);
  EXPECT_GT(result.nees(), 0.3);
  EXPECT_LT(result.nees(), 1.5);
  record(result);
}

TEST(BodyTracker, FollowsOneTurnPerSecond) {
  FollowedBody follow(paperRig(), fourLeds(), tumbling, halfAPixel(), 22);
  const BodyScore result = score(&follow, 6.0);
  EXPECT_GT(result.known(), 0.999);
  EXPECT_LT(result.wrong(), 0.001);
  EXPECT_LT(result.positionRatio(), 1.1);
  EXPECT_LT(result.rotationRatio(), 1.1);
  record(result);
}

TEST(BodyTracker, IsNotLostWhenItIsShaken) {
  const auto shaken = [](double t) {
    Isometry3d pose = handheld(t);
    pose.translation().x() += 0.1 * std::sin(2.0 * M_PI * 2.0 * t);  // up to 16 m/s^2
    pose.linear() = Eigen::AngleAxisd(0.5 * std::sin(2.0 * M_PI * 2.5 * t), Vector3d::UnitY())
                        .toRotationMatrix() *
                    pose.linear();
    return pose;
  };
  FollowedBody follow(paperRig(), fourLeds(), shaken, halfAPixel(), 28);
  const BodyScore result = score(&follow, 6.0);
  EXPECT_EQ(result.known(), 1.0);
  EXPECT_EQ(result.wrong(), 0.0);
  EXPECT_LT(result.nees(), 3.0);
  record(result);
}

TEST(BodyTracker, MergedSpotsDoNotBiasThePose) {
  tracking::test::SceneOptions options = halfAPixel();
  options.merging_distance = 12.0;
  FollowedBody follow(paperRig(), fourLeds(), handheld, options, 29);
  const BodyScore result = score(&follow, 8.0);
  EXPECT_EQ(result.known(), 1.0);
  EXPECT_EQ(result.wrong(), 0.0);
  // The bound knows nothing of merging.
  EXPECT_LT(result.positionRatio(), 1.3);
  EXPECT_LT(result.rotationRatio(), 1.3);
  EXPECT_LT(result.nees(), 1.5);
  record(result);
}

TEST(BodyTracker, OneLedOfFourMayBeHidden) {
  tracking::test::SceneOptions options = halfAPixel();
  options.hidden = [](std::size_t, std::size_t led, double) { return led == 2; };
  FollowedBody follow(paperRig(), fourLeds(), handheld, options, 23);
  const BodyScore result = score(&follow, 4.0);
  EXPECT_EQ(result.known(), 1.0);
  EXPECT_EQ(result.wrong(), 0.0);
  ASSERT_TRUE(follow.estimate());
  EXPECT_TRUE(std::isnan(follow.estimate()->leds[2].deviation));
  EXPECT_LT(follow.estimate()->leds[0].deviation, 0.02);
  EXPECT_TRUE(follow.estimate()->leds[2].cameras.empty());
  EXPECT_GE(follow.estimate()->leds[0].cameras.size(), 2u);
}

TEST(BodyTracker, FindsTheBodyAgainSoonAfterItWasHidden) {
  tracking::test::SceneOptions options = halfAPixel();
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 2.0) > 1.2; };
  FollowedBody follow(paperRig(), fourLeds(), handheld, options, 24);
  int occlusions = 0;
  bool was_lost = false;
  for (int i = 0; i < 4 * 100 * 20; ++i) {
    follow.step();
    const double since = std::fmod(follow.time(), 2.0);
    if (since > 1.3 && since < 1.9 && follow.estimate()) {
      EXPECT_FALSE(follow.estimate()->tracked);
    }
    was_lost = was_lost || !follow.estimate();
    if (was_lost && since > 0.2 && since < 1.2) {
      ++occlusions;
      was_lost = false;
      ASSERT_TRUE(follow.estimate()) << "0.2 s after the light came back";
      EXPECT_LT(rotationError(follow.truth(), follow.estimate()->world_from_body).norm(), 0.1);
    }
  }
  EXPECT_GE(occlusions, 8);
}

TEST(BodyTracker, OneCameraIsEnoughForFourLeds) {
  tracking::test::SceneOptions options = halfAPixel();
  options.hidden = [](std::size_t camera, std::size_t, double t) {
    return t > 1001.0 && camera != 1;
  };
  FollowedBody follow(paperRig(), fourLeds(), handheld, options, 25);
  while (follow.time() < 1010.0)
    follow.step();
  ASSERT_TRUE(follow.estimate());
  EXPECT_TRUE(follow.estimate()->tracked);
  EXPECT_LT(
      (follow.estimate()->world_from_body.translation() - follow.truth().translation()).norm(),
      0.15);
  EXPECT_LT(rotationError(follow.truth(), follow.estimate()->world_from_body).norm(), 0.3);
}

TEST(BodyTracker, TwoBodiesAndAFreeLed) {
  const Constellation other{"other", {{0.1, 0.0, 0.0}, {-0.08, 0.02, 0.0}, {0.0, 0.07, 0.05}}};
  const auto second = [](double t) {
    Isometry3d pose = handheld(t + 3.0);
    pose.translation() += Vector3d(0.1, -0.3, 0.3);
    return pose;
  };
  std::vector<tracking::test::Path> paths = pathsOf(fourLeds(), handheld);
  for (const auto& path : pathsOf(other, second))
    paths.push_back(path);
  paths.push_back(tracking::test::still({1.0, 1.6, 0.7}));
  tracking::test::SceneOptions options = halfAPixel();
  options.maximum_spots = 8;
  tracking::test::Scene scene(paperRig(), paths, options, 26);
  BodyTracker tracker(paperRig(), {fourLeds(), other}, BodyTrackerOptions());
  int known = 0;
  int good = 0;
  while (tracker.time() < 1006.0 || std::isinf(tracker.time())) {
    const tracking::test::SceneImage& image = scene.next();
    test::take(image, &tracker);
    if (tracker.time() < 1001.0 || !tracker.bodies()[0] || !tracker.bodies()[1])
      continue;
    ++known;
    const double first_error =
        rotationError(handheld(tracker.time()), tracker.bodies()[0]->world_from_body).norm();
    const double second_error =
        rotationError(second(tracker.time()), tracker.bodies()[1]->world_from_body).norm();
    good += first_error < 0.2 && second_error < 0.2 ? 1 : 0;
  }
  EXPECT_GE(known, 1900);
  EXPECT_GE(good, known * 99 / 100);
}

/// Images of a body at rest without errors, camera by camera.
void showExactly(const Isometry3d& pose,
                 const std::vector<Vector3d>& leds,
                 int first,
                 int last,
                 BodyTracker* tracker) {
  const geometry::Rig rig = paperRig();
  for (int i = first; i < last; ++i) {
    const geometry::Camera& camera = rig.cameras[static_cast<std::size_t>(i) % 4].camera;
    std::vector<Eigen::Vector2d> pixels;
    for (const Vector3d& led : leds) {
      if (camera.sees(pose * led))
        pixels.push_back(*camera.project(pose * led));
    }
    test::take(static_cast<std::size_t>(i) % 4, 1000.0 + 0.0025 * i, pixels, tracker);
  }
}

TEST(BodyTracker, DoesNotGuessAnAmbiguousPose) {
  // Two of these three LEDs may be exchanged.
  const std::vector<Vector3d> all = fourLeds().leds;
  BodyTracker tracker(paperRig(), {fourLeds()}, BodyTrackerOptions());
  const Isometry3d pose(Eigen::Translation3d(1.2, 1.3, 1.1));
  showExactly(pose, {all[0], all[1], all[2]}, 0, 40, &tracker);
  EXPECT_FALSE(tracker.bodies()[0]);
  showExactly(pose, all, 40, 80, &tracker);
  ASSERT_TRUE(tracker.bodies()[0]);
  EXPECT_LT(rotationError(pose, tracker.bodies()[0]->world_from_body).norm(), 0.01);
}

TEST(BodyTracker, ABodyThatComesBackElsewhereIsTheSame) {
  const std::vector<Vector3d> leds = fourLeds().leds;
  BodyTracker tracker(paperRig(), {fourLeds()}, BodyTrackerOptions());
  showExactly(Isometry3d(Eigen::Translation3d(1.0, 1.3, 1.1)), leds, 0, 100, &tracker);
  ASSERT_TRUE(tracker.bodies()[0]);
  const double first_seen = tracker.bodies()[0]->first_seen;
  showExactly(Isometry3d::Identity(), {}, 100, 140, &tracker);  // 0.1 s in the dark
  ASSERT_TRUE(tracker.bodies()[0]);
  EXPECT_FALSE(tracker.bodies()[0]->tracked);
  const Isometry3d elsewhere(Eigen::Translation3d(1.7, 1.1, 1.0));
  int i = 140;
  do {
    ASSERT_LT(i, 200);
    showExactly(elsewhere, leds, i, i + 1, &tracker);
    ++i;
  } while (!tracker.bodies()[0]->tracked);
  EXPECT_LT((tracker.bodies()[0]->world_from_body.translation() - elsewhere.translation()).norm(),
            0.01);
  EXPECT_EQ(tracker.bodies()[0]->first_seen, first_seen);
}

/// A square of LEDs, seen for some images: its shape alone has four poses.
class SymmetricBody : public ::testing::Test {
 protected:
  SymmetricBody() { showExactly(pose_, square_.leds, 0, 40, &tracker_); }

  static BodyTrackerOptions options() {
    BodyTrackerOptions options;
    options.minimum_margin = 0.0;
    return options;
  }

  Random random_{43};
  const Constellation square_{"square",
                              {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}},
                              {"a", "b", "c", "d"}};
  const Isometry3d pose_ = randomPose(random_, {1.2, 1.3, 1.1});
  BodyTracker tracker_{paperRig(), {square_}, options()};
};

TEST_F(SymmetricBody, IsFoundByItsLabels) {
  EXPECT_FALSE(tracker_.bodies()[0]) << "its shape is ambiguous";
  std::vector<LabelledPoint> points;
  for (const std::size_t led : {3, 0, 2})
    points.push_back(
        {square_.labels[led], pose_ * square_.leds[led], 1e-6 * Eigen::Matrix3d::Identity()});
  points.push_back({"else", Vector3d(0, 0, 0), 1e-6 * Eigen::Matrix3d::Identity()});
  std::vector<LabelledPoint> wrong = points;
  std::swap(wrong[0].position, wrong[1].position);
  wrong[2].position.z() += 0.1;
  tracker_.startFromLabels(wrong);
  EXPECT_FALSE(tracker_.bodies()[0]) << "they do not lie as on the body";
  tracker_.startFromLabels({points[0], points[1]});
  EXPECT_FALSE(tracker_.bodies()[0]) << "two are not enough";
  tracker_.startFromLabels(points);
  showExactly(pose_, square_.leds, 40, 200, &tracker_);
  ASSERT_TRUE(tracker_.bodies()[0]);
  EXPECT_LT(rotationError(pose_, tracker_.bodies()[0]->world_from_body).norm(), 0.01);
  // It keeps its state, and is not initialised again.
  const MotionCovariance covariance = tracker_.bodies()[0]->covariance;
  tracker_.startFromLabels(points);
  EXPECT_EQ(tracker_.bodies()[0]->covariance, covariance);
}

TEST_F(SymmetricBody, FoundByItsLabelsSurvivesALateImage) {
  std::vector<LabelledPoint> points;
  for (std::size_t led = 0; led < 3; ++led)
    points.push_back(
        {square_.labels[led], pose_ * square_.leds[led], 1e-6 * Eigen::Matrix3d::Identity()});
  tracker_.startFromLabels(points);
  ASSERT_TRUE(tracker_.bodies()[0]);
  const double first_seen = tracker_.bodies()[0]->first_seen;
  test::take(0, tracker_.time() - 0.005, {}, &tracker_);
  ASSERT_TRUE(tracker_.bodies()[0]) << "the newest image was computed again";
  EXPECT_EQ(tracker_.bodies()[0]->first_seen, first_seen);
  // Also after another body has come first.
  const Constellation other{"other", {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.4, 0.1}}};
  tracker_.setBodies({other, square_});
  test::take(1, tracker_.time() - 0.005, {}, &tracker_);
  EXPECT_FALSE(tracker_.bodies()[0]);
  ASSERT_TRUE(tracker_.bodies()[1]);
  EXPECT_EQ(tracker_.bodies()[1]->first_seen, first_seen);
  EXPECT_LT(rotationError(pose_, tracker_.bodies()[1]->world_from_body).norm(), 0.01);
}

TEST(BodyTracker, ASilentCameraIsNotReported) {
  const Isometry3d pose(Eigen::Translation3d(1.2, 1.3, 1.1));
  BodyTracker tracker(paperRig(), {fourLeds()}, BodyTrackerOptions());
  showExactly(pose, fourLeds().leds, 0, 40, &tracker);
  ASSERT_TRUE(tracker.bodies()[0]);
  const auto sees = [&](std::size_t camera) {
    const std::vector<LedEstimate>& leds = tracker.bodies()[0]->leds;
    return std::any_of(leds.begin(), leds.end(), [&](const LedEstimate& led) {
      return std::count(led.cameras.begin(), led.cameras.end(), camera) > 0;
    });
  };
  EXPECT_TRUE(sees(3));
  for (int i = 40; i < 80; ++i) {
    if (i % 4 != 3)
      showExactly(pose, fourLeds().leds, i, i + 1, &tracker);
  }
  EXPECT_TRUE(sees(2));
  EXPECT_FALSE(sees(3));
}

}  // namespace
}  // namespace wiimote_tracker::body
