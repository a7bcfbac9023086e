// A clock whose new epoch the rig has no time offset for is found from the motion.
#include "geometry/accuracy.h"
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr double kReconnect = 2.0;  // since the start [s]

struct Figures {
  std::vector<double> errors;        // of the time of the camera's last image, per scene [s]
  std::vector<double> stated;        // its standard deviation [s]
  geometry::test::Accuracy tracked;  // since the reconnection
};

/// One of four cameras, each time another, reconnects; its stamps are then late
/// by `offset` [s]. LEDs move at 0.5 m/s for 5 s more.
void reconnect(unsigned seed, double offset, bool is_known, double jitter, Figures* figures) {
  geometry::Rig rig = paperRig();
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.time_offset = 0.0;
    camera.time_offset_rule =
        is_known ? geometry::TimeOffsetRule::kAlways : geometry::TimeOffsetRule::kOneEpoch;
  }
  const std::size_t reconnected = seed % 4;
  const std::vector<Path> leds = wanderers(2, seed, 0.5);
  SceneOptions options;
  options.dropout = 0.02;
  options.ghosts = 0.1;
  options.delay_jitter = jitter;
  Scene scene(rig, leds, options, seed);
  Tracker tracker(rig, exactOptions());
  double error = std::numeric_limits<double>::quiet_NaN();  // fails if it is never found
  double stated = error;
  for (double time = 0.0; time < kReconnect + 5.0;) {
    SceneImage image = scene.next();
    time = image.true_time - options.start;
    const bool is_after = time >= kReconnect;
    if (image.camera == reconnected && is_after) {
      image.image.stamp += offset;
      image.image.clock_epoch = 1;
    }
    tracker.add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker.next()) {
      if (!is_after)
        continue;
      const CameraView& view = snapshot->views[image.camera];
      if (image.camera == reconnected) {
        error = *view.time - image.true_time;
        stated = view.stamp_stddev;
      }
      for (const TrackedLed& led : snapshot->leds) {
        if (led.state != TrackState::kTracked)
          continue;
        Eigen::Vector3d off = led.position - leds[0](snapshot->time);
        const Eigen::Vector3d other = led.position - leds[1](snapshot->time);
        if (other.norm() < off.norm())
          off = other;
        figures->tracked.add(off, led.position_covariance);
      }
    }
  }
  figures->errors.push_back(error);
  figures->stated.push_back(stated);
}

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values)
    squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(TrackerEpochs, TheOffsetOfANewEpochIsFoundFromTheMotion) {
  Figures found;
  Figures exact;
  Figures wrong;
  std::size_t within_two = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const double offset = 0.005 * geometry::test::Random(seed + 100).gaussian();
    reconnect(seed, offset, false, 0.0, &found);
    reconnect(seed, 0.0, true, 0.0, &exact);
    reconnect(seed, offset, true, 0.0, &wrong);
    EXPECT_LE(std::abs(found.errors.back()), 3.5 * found.stated.back()) << seed;
    within_two += std::abs(found.errors.back()) <= 2.0 * found.stated.back();
  }
  EXPECT_LE(rms(found.errors), 0.00025);
  EXPECT_LE(rms(found.stated), 0.0003);
  EXPECT_GE(within_two, 17u);
  EXPECT_LT(found.tracked.rms(), 1.02 * exact.tracked.rms());
  EXPECT_LT(found.tracked.rms(), wrong.tracked.rms());
  EXPECT_GT(found.tracked.shareInside(), 0.94);
}

TEST(TrackerEpochs, TheOffsetIsFoundFromLateImages) {
  Figures found;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    reconnect(seed, 0.004, false, 0.005, &found);
    EXPECT_LE(std::abs(found.errors.back()), 3.5 * found.stated.back()) << seed;
  }
  EXPECT_LE(rms(found.errors), 0.0004);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
