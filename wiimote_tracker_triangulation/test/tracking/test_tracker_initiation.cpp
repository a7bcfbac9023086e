// How soon and how well LEDs are located that come into view, or back.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>

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
  double squares = 0.0;
  int count = 0, inside = 0;
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
      const Eigen::Vector3d error = found.position - led(snapshot.time);
      squares += error.squaredNorm();
      inside += error.dot(found.position_covariance.inverse() * error) < 7.815;  // 95 %
      ++count;
    }
  }
  ASSERT_EQ(450, count);
  EXPECT_LT(std::sqrt(squares / count), 0.005);
  EXPECT_NEAR(0.95, static_cast<double>(inside) / count, 0.04);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
