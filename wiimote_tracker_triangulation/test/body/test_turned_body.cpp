// Wrong orientations of a body, in which two of its LEDs are exchanged.
#include "body/body_scene.h"
#include "body/body_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wiimote_tracker::body {
namespace {

using Eigen::Vector3d;
using test::Motion;

/// The paper's two neighbouring cameras see a body of 0.1 m from 4 m, so that some wrong poses fit
/// many of its spots.
TEST(ExtensiveTurnedBody, IsRareWithTwoCameras) {
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(2);
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  for (const Constellation& body : {test::threeLeds(), test::fourLeds()}) {
    for (const Motion& motion : {Motion(test::held), Motion(test::handheld)}) {
      test::BodyScore score;
      for (unsigned seed = 1; seed < 11; ++seed) {
        test::FollowedBody follow(rig, body, motion, options, seed);
        while (!(follow.time() > 1010.0)) {
          follow.step();
          if (follow.time() > 1000.5)
            score.add(follow);
        }
      }
      EXPECT_GT(score.known(), 0.999) << body.name;
      EXPECT_LT(score.wrong(), 0.002) << body.name;  // 0
      EXPECT_GT(score.nees(), 0.6) << body.name;
      EXPECT_LT(score.nees(), 1.2) << body.name;
    }
  }
}

/// It is hidden for the last 0.1 s of each second.
TEST(ExtensiveTurnedBody, IsRareAfterABodyWasHidden) {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 1.0) > 0.9; };
  int images = 0;
  int tracked = 0;
  int wrong = 0;
  for (unsigned seed = 25; seed < 33; ++seed) {
    test::FollowedBody follow(tracking::test::paperRig(), test::fourLeds(), test::shaken, options,
                              seed);
    for (int i = 0; i < 4 * 100 * 20; ++i) {
      follow.step();
      ++images;
      if (!follow.estimate() || !follow.estimate()->tracked)
        continue;
      ++tracked;
      wrong +=
          test::rotationError(follow.truth(), follow.estimate()->world_from_body).norm() > 0.35;
    }
  }
  EXPECT_GT(tracked, 0.85 * images);
  EXPECT_LT(wrong, 0.05 * tracked);  // 0.014
}

/// Two cameras report four spots each: another LED beside the body hides one of its LEDs.
TEST(TurnedBody, IsRareBesideAnotherLed) {
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(2);
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.integer_pixels = true;
  int wrong = 0;
  int images = 0;
  for (unsigned seed = 1; seed < 61; ++seed) {
    geometry::test::Random random(1000 + seed);
    Eigen::Isometry3d turn = test::randomPose(random, Vector3d::Zero());
    turn.translation().setZero();
    const Motion motion = [seed, turn](double t) -> Eigen::Isometry3d {
      return test::held(t + 3.7 * seed) * turn;
    };
    std::vector<tracking::test::Path> paths = test::pathsOf(test::fourLeds(), motion);
    paths.emplace_back([motion](double t) -> Vector3d {
      return motion(t).translation() + Vector3d(0.2 * std::sin(5.0 * t), 0.2, 0.1);
    });
    tracking::test::Scene scene(rig, paths, options, seed);
    BodyTracker tracker(rig, {test::fourLeds()}, BodyTrackerOptions());
    while (!(tracker.time() > 1005.0)) {
      const tracking::test::SceneImage& image = scene.next();
      test::take(image, &tracker);
      if (!tracker.bodies()[0])
        continue;
      ++images;
      const Eigen::Isometry3d truth = motion(tracker.time());
      wrong += test::rotationError(truth, tracker.bodies()[0]->world_from_body).norm() > 0.35;
    }
  }
  EXPECT_GT(images, 59000);
  EXPECT_LT(wrong, 0.004 * images);  // 0.002
}

/// A new body is found with each seed, while another LED moves beside it.
TEST(TurnedBody, IsFoundAgain) {
  constexpr double kBegin = 1000.5;  // [s]
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  int wrong = 0;
  int images = 0;
  for (unsigned seed = 100; seed < 160; ++seed) {
    const Motion motion = [seed](double t) { return test::shaken(t + seed); };
    std::vector<tracking::test::Path> paths = test::pathsOf(test::fourLeds(), motion);
    paths.emplace_back([motion](double t) -> Vector3d {
      return motion(t).translation() + Vector3d(0.2 * std::sin(5.0 * t), 0.2, 0.1);
    });
    tracking::test::Scene scene(tracking::test::paperRig(), paths, options, seed);
    BodyTracker tracker(tracking::test::paperRig(), {test::fourLeds()}, BodyTrackerOptions());
    while (!(tracker.time() > kBegin + 0.5)) {
      const tracking::test::SceneImage& image = scene.next();
      test::take(image, &tracker);
      if (tracker.time() < kBegin || !tracker.bodies()[0])
        continue;
      ++images;
      const Eigen::Isometry3d truth = motion(tracker.time());
      wrong += test::rotationError(truth, tracker.bodies()[0]->world_from_body).norm() > 0.35;
    }
  }
  EXPECT_GT(images, 60 * 150);
  EXPECT_LT(wrong, 0.01 * images);
}

}  // namespace
}  // namespace wiimote_tracker::body
