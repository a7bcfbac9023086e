// A hidden body is silent, also while another LED is lit near its place.
#include "body/body_scene.h"
#include "body/body_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace wiimote_tracker::body {
namespace {

using Eigen::Vector3d;
using test::Motion;

constexpr double kCycle = 2.0;       // [s]
constexpr double kHiddenFrom = 1.2;  // since the cycle's beginning, to its end [s]
constexpr double kSilence = 0.05;    // after the last sight, at the latest [s]

/// When the body is hidden in the cycle of this time [s].
double hiddenFrom(double time) {
  return std::floor(time / kCycle) * kCycle + kHiddenFrom;
}

/// An LED that is lit while the body is hidden.
struct OtherLed {
  Motion motion;           // of the body
  std::size_t led;         // of the body, at whose last place it appears
  Vector3d offset;         // from there [m]
  double velocity_factor;  // its velocity, as a factor of that LED's

  Vector3d operator()(double time) const {
    constexpr double kStep = 1e-3;  // [s]
    const double begin = hiddenFrom(time);
    const Vector3d in_body = test::fourLeds().leds[led];
    const Vector3d place = motion(begin) * in_body;
    const Vector3d velocity = (motion(begin + kStep) * in_body - place) / kStep;
    return place + offset + (time - begin) * velocity_factor * velocity;
  }
};

/// Of the times that a body was hidden, those in which it still was tracked kSilence later.
struct Hidings {
  int all = 0;
  int late = 0;
};

void hideFourTimes(const Motion& motion,
                   const std::vector<OtherLed>& others,
                   unsigned seed,
                   Hidings* hidings) {
  const Constellation body = test::fourLeds();
  std::vector<tracking::test::Path> paths = test::pathsOf(body, motion);
  for (const OtherLed& other : others)
    paths.emplace_back(other);
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.hidden = [&](std::size_t, std::size_t led, double time) {
    return (led < body.leds.size()) == (time > hiddenFrom(time));
  };
  tracking::test::Scene scene(tracking::test::paperRig(), paths, options, seed);
  BodyTracker tracker(tracking::test::paperRig(), {body}, BodyTrackerOptions());
  double end = 0.0;       // of the last judged cycle
  double late_end = 0.0;  // of the last one in which it was late
  for (int i = 0; i < 4 * 100 * 8; ++i) {
    const tracking::test::SceneImage& image = scene.next();
    test::take(image, &tracker);
    const double begin = hiddenFrom(tracker.time());
    if (tracker.time() < begin + kSilence)
      continue;
    hidings->all += begin > end ? 1 : 0;
    end = std::max(end, begin);
    if (begin > late_end && tracker.bodies()[0] && tracker.bodies()[0]->tracked) {
      ++hidings->late;
      late_end = begin;
    }
  }
}

const std::array<Motion, 4> kMotions = {test::held, test::handheld, test::shaken, test::tumbling};

TEST(ExtensiveHiddenBody, IsSilent) {
  Hidings hidings;
  for (const Motion& motion : kMotions) {
    for (unsigned seed = 0; seed < 4; ++seed)
      hideFourTimes(motion, {}, seed, &hidings);
  }
  EXPECT_EQ(hidings.all, 64);
  EXPECT_EQ(hidings.late, 0);
}

/// Up to 0.1 m from where one of its LEDs was.
TEST(ExtensiveHiddenBody, IsSilentWhileAnotherLedIsLitAtItsPlace) {
  geometry::test::Random random(51);
  Hidings hidings;
  for (const Motion& motion : kMotions) {
    for (const double distance : {0.01, 0.03, 0.1}) {
      for (unsigned seed = 0; seed < 4; ++seed) {
        const Vector3d offset = random.inBox(distance);
        for (const double velocity_factor : {0.0, 1.0})
          hideFourTimes(motion, {{motion, seed, offset, velocity_factor}}, seed, &hidings);
      }
    }
  }
  EXPECT_EQ(hidings.all, 384);
  EXPECT_EQ(hidings.late, 0);
}

/// Each up to 0.2 m along each axis from where another of its LEDs was. Some have by chance the
/// distances of LEDs of the body.
TEST(ExtensiveHiddenBody, IsMostlySilentWhileTwoOrThreeOtherLedsAreLitBesideIt) {
  geometry::test::Random random(51);
  Hidings hidings;
  for (const Motion& motion : kMotions) {
    for (const std::size_t count : {2, 3}) {
      for (unsigned seed = 0; seed < 6; ++seed) {
        std::vector<OtherLed> others;
        for (std::size_t led = 0; led < count; ++led)
          others.push_back({motion, led, random.inBox(0.2), seed % 2 == 0 ? 0.0 : 1.0});
        hideFourTimes(motion, others, seed, &hidings);
      }
    }
  }
  EXPECT_EQ(hidings.all, 192);
  EXPECT_LT(hidings.late, 20);
}

/// Follows a body of which each camera sees another LED only, once it was found.
test::BodyScore scoreOfOneLedPerCamera(const Constellation& body, const Motion& motion) {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.hidden = [](std::size_t camera, std::size_t led, double time) {
    return time > 1001.0 && led != camera;
  };
  test::FollowedBody follow(tracking::test::paperRig(), body, motion, options, 52);
  test::BodyScore score;
  while (!(follow.time() > 1009.0)) {
    follow.step();
    if (follow.time() < 1001.0)
      continue;
    score.add(follow);
    EXPECT_TRUE(follow.estimate() && follow.estimate()->tracked) << follow.time() << " s";
    if (testing::Test::HasFailure())
      break;
  }
  EXPECT_EQ(score.wrong(), 0.0);
  return score;
}

TEST(HiddenBody, IsNotHiddenWhileEachCameraSeesAnotherOfItsLeds) {
  EXPECT_LT(scoreOfOneLedPerCamera(test::fourLeds(), test::handheld).position(), 0.004);
}

/// Nor is one whose LEDs are 14 to 40 mm apart, although all rays pass its middle within 20 mm.
TEST(HiddenBody, IsNotHiddenWhileEachCameraSeesAnotherOfItsCloseLeds) {
  const Constellation body = {
      "small", {{0.0, 0.0, 0.0}, {0.037, 0.0, 0.0}, {0.0, 0.014, 0.0}, {0.01, 0.02, 0.024}}};
  EXPECT_LT(scoreOfOneLedPerCamera(body, test::held).position(), 0.008);
}

}  // namespace
}  // namespace wiimote_tracker::body
