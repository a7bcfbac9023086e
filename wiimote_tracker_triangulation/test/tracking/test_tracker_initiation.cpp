// How soon and how well LEDs are located that come into view, or back.
#include "geometry/accuracy.h"
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

geometry::Rig pairOfCameras() {
  geometry::Rig rig = paperRig();
  rig.cameras.resize(2);
  return rig;
}

TEST(TrackerInitiation, TheFirstPointsOfAMovingLedAreExact) {
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  SceneOptions scene;
  scene.period = 1.0 / 30.0;
  scene.hidden = [](std::size_t, std::size_t, double time) { return time < 1000.3; };
  TrackerOptions options = exactOptions();
  options.birth_pixel_stddev = 15.0;  // the motion within birth_window
  options.confirmation_hits = 2;
  geometry::test::Random random(4);
  geometry::test::Accuracy accuracy;
  const geometry::Rig rig = pairOfCameras();
  for (unsigned run = 0; run < 150; ++run) {
    const Path led = straight(middle, 2.0 * random.inBox(1.0).normalized(), 1000.4);
    Tracker tracker(rig, options);
    int points = 0;
    for (const Snapshot& snapshot : track(&tracker, imagesOf(rig, {led}, scene, 40, run))) {
      if (idsIn(snapshot, TrackState::kTracked).empty() || points == 3)
        continue;
      ++points;
      const TrackedLed& found = snapshot.leds[0];
      accuracy.add(found.position - led(snapshot.time), found.position_covariance);
    }
  }
  ASSERT_EQ(450, accuracy.count);
  EXPECT_LT(accuracy.rms(), 0.005);
  EXPECT_NEAR(0.95, accuracy.shareInside(), 0.04);
}

/// Those of the newest image and of the other camera's, which is older.
TEST(TrackerInitiation, TheSpotsThatBeginATrackAreNamed) {
  const geometry::Rig rig = pairOfCameras();
  const Path led = straight({1.25, 1.25, 1.0}, {1.0, 0.5, 0.0}, 1000.4);
  Tracker tracker(rig, exactOptions());
  const std::vector<Snapshot> snapshots = track(&tracker, imagesOf(rig, {led}, SceneOptions(), 40));
  const auto first = std::find_if(snapshots.begin(), snapshots.end(),
                                  [](const Snapshot& s) { return !s.leds.empty(); });
  ASSERT_NE(snapshots.end(), first);
  ASSERT_NE(first->views[0].time, first->views[1].time);
  for (const CameraView& view : first->views) {
    ASSERT_EQ(1u, view.spots.size());
    EXPECT_EQ(SpotUse::kStart, view.spots[0].use);
    EXPECT_EQ(first->leds[0].id, view.spots[0].led);
  }
  for (auto later = first + 1; later != snapshots.end(); ++later) {
    for (const CameraView& view : later->views)
      EXPECT_EQ(*view.time > first->time ? SpotUse::kAssigned : SpotUse::kStart, view.spots[0].use);
  }
}

/// Towards camera 0 and back, so that it leaves camera 1's image for half a period. The prediction
/// by camera 0 alone goes on outwards.
TEST(TrackerInitiation, AnLedThatTurnsBackIntoAnImageIsLocatedAtOnce) {
  constexpr double kLeaves = 1001.0, kFrequency = 5.0;  // [s], [rad/s]
  const geometry::Rig rig = pairOfCameras();
  const geometry::Camera& alone = rig.cameras[0].camera;
  const geometry::Camera& other = rig.cameras[1].camera;
  const Eigen::Vector3d ray = (Eigen::Vector3d(1.25, 1.25, 1.0) - alone.center()).normalized();
  double edge = 1.0;  // of the other's image [m]
  while (!other.sees(alone.center() + edge * ray))
    edge += 0.01;
  for (const double amplitude : {0.2, 0.3}) {
    const Path led = [&](double time) -> Eigen::Vector3d {
      const double phase = kFrequency * (time - kLeaves);
      return alone.center() + (edge - amplitude * std::sin(phase)) * ray +
             0.5 * (time - kLeaves) * ray.unitOrthogonal();
    };
    Tracker tracker(rig, exactOptions());
    double last_hidden = 0.0;
    std::size_t predicted = 0;
    for (const Snapshot& snapshot : track(&tracker, imagesOf(rig, {led}, SceneOptions(), 400))) {
      if (snapshot.time < kLeaves)
        continue;
      if (!other.sees(led(snapshot.time)))
        last_hidden = snapshot.time;
      const bool is_tracked = idsIn(snapshot, TrackState::kTracked) == std::set<std::uint32_t>{0};
      predicted += !is_tracked;
      if (snapshot.time > last_hidden + 0.05) {
        EXPECT_TRUE(is_tracked) << amplitude << " m, " << snapshot.time - last_hidden << " s";
      }
    }
    EXPECT_GT(last_hidden, kLeaves + 0.4);
    EXPECT_GT(predicted, 40u);
  }
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
