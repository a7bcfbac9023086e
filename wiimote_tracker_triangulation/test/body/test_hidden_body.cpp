// A hidden body is silent, also while another LED is lit near its place.
#include "body/body_scene.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker::body {
namespace {

using Eigen::Vector3d;

constexpr double kCycle = 2.0;       // [s]
constexpr double kHiddenFrom = 1.2;  // since the cycle's beginning, to its end [s]
constexpr double kSilence = 0.05;    // after the last sight, at the latest [s]

/// When the body is hidden in the cycle of this time [s].
double hiddenFrom(double time) {
  return std::floor(time / kCycle) * kCycle + kHiddenFrom;
}

/// An LED that is lit while the body is hidden.
struct OtherLed {
  std::size_t led;         // of the body, at whose last place it appears
  Vector3d offset;         // from there [m]
  double velocity_factor;  // its velocity, as a factor of that LED's

  Vector3d operator()(double time) const {
    constexpr double kStep = 1e-3;  // [s]
    const double begin = hiddenFrom(time);
    const Vector3d in_body = test::fourLeds().leds[led];
    const Vector3d place = test::handheld(begin) * in_body;
    const Vector3d velocity = (test::handheld(begin + kStep) * in_body - place) / kStep;
    return place + offset + (time - begin) * velocity_factor * velocity;
  }
};

/// Of the snapshots later than kSilence after the last sight.
struct Snapshots {
  int all = 0;
  int tracked = 0;
  int observed = 0;  // later than kSilence
};

void hideTenTimes(const OtherLed& other, unsigned seed, Snapshots* snapshots) {
  const Constellation body = test::fourLeds();
  std::vector<tracking::test::Path> paths = test::pathsOf(body, test::handheld);
  paths.emplace_back(other);
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.hidden = [&](std::size_t, std::size_t led, double time) {
    return (led < body.leds.size()) == (time > hiddenFrom(time));
  };
  tracking::test::Scene scene(tracking::test::paperRig(), paths, options, seed);
  BodyTracker tracker(tracking::test::paperRig(), {body}, BodyTrackerOptions());
  for (int i = 0; i < 4 * 100 * 20; ++i) {
    const tracking::test::SceneImage& image = scene.next();
    std::vector<Eigen::Vector2d> pixels;
    for (const tracking::Spot& spot : image.image.spots)
      pixels.push_back(spot.pixel);
    tracker.add(image.camera, image.image.stamp, pixels);
    const double silent_from = hiddenFrom(tracker.time()) + kSilence;
    if (tracker.time() < silent_from)
      continue;
    ++snapshots->all;
    if (!tracker.bodies()[0])
      continue;
    snapshots->tracked += tracker.bodies()[0]->tracked ? 1 : 0;
    snapshots->observed += tracker.bodies()[0]->last_observed > silent_from ? 1 : 0;
  }
}

TEST(HiddenBody, IsSilentWhileAnotherLedIsLitAtItsPlace) {
  geometry::test::Random random(51);
  Snapshots snapshots;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Vector3d offset = random.inBox(0.01);
    for (const double velocity_factor : {0.0, 0.5, 1.0})
      hideTenTimes({seed % 4, offset, velocity_factor}, seed, &snapshots);
  }
  ASSERT_GT(snapshots.all, 70000);
  EXPECT_LT(snapshots.tracked, 0.02 * snapshots.all);
  EXPECT_LT(snapshots.observed, 0.02 * snapshots.all);
  RecordProperty("tracked", std::to_string(snapshots.tracked));
  RecordProperty("observed", std::to_string(snapshots.observed));
  RecordProperty("all", std::to_string(snapshots.all));
}

TEST(HiddenBody, IsNotHiddenWhileEachCameraSeesAnotherOfItsLeds) {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.hidden = [](std::size_t camera, std::size_t led, double time) {
    return time > 1001.0 && led != camera;
  };
  test::FollowedBody follow(tracking::test::paperRig(), test::fourLeds(), test::handheld, options,
                            52);
  test::BodyScore score;
  while (!(follow.time() > 1009.0)) {
    follow.step();
    if (follow.time() < 1001.0)
      continue;
    score.add(follow);
    ASSERT_TRUE(follow.estimate());
    ASSERT_TRUE(follow.estimate()->tracked);
  }
  EXPECT_EQ(score.wrong(), 0.0);
  EXPECT_LT(score.position(), 0.004);
}

}  // namespace
}  // namespace wiimote_tracker::body
