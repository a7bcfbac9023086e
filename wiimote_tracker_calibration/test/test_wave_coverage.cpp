// What a person is told while waving.
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "expect_says.h"

#include "wave/coverage.h"

#include <wiimote_tracker_msgs/text.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker::wave {
namespace {

/// All frames of a recording up to a time after its start, in the order of time.
void feed(const Recording& recording, double seconds, Coverage* coverage) {
  const double start = recording.cameras[0].frames.front().stamp;
  std::vector<std::size_t> next(recording.cameras.size(), 0);
  while (true) {
    std::size_t first = next.size();
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (next[i] < recording.cameras[i].frames.size() &&
          (first == next.size() || recording.cameras[i].frames[next[i]].stamp <
                                       recording.cameras[first].frames[next[first]].stamp))
        first = i;
    }
    if (first == next.size() ||
        recording.cameras[first].frames[next[first]].stamp > start + seconds)
      return;
    coverage->add(first, recording.cameras[first].frames[next[first]++]);
  }
}

/// All that is said to be missing.
std::string missing(const CoverageReport& report) {
  return joined(report.missing, "\n");
}

TEST(Coverage, IsEmptyBeforeTheFirstFrame) {
  const SimulatedWave wave = simulateWave(WaveScene(), 1);
  const Coverage coverage(wave.cameras, true, 1, CoverageOptions());
  const CoverageReport report = coverage.report();
  EXPECT_FALSE(report.enough());
  ASSERT_EQ(report.cameras.size(), 4u);
  EXPECT_SAYS(missing(report), "camera_3 has not seen the LED move");
  EXPECT_EQ(report.seconds, 0.0);
  EXPECT_FALSE(report.speed.has_value());
}

TEST(Coverage, GrowsUntilComplete) {
  WaveScene scene;
  scene.duration = 40.0;
  for (const double length : {0.0, 0.5}) {
    scene.length = length;
    const SimulatedWave wave = simulateWave(scene, 2);
    Coverage half(wave.cameras, true, length > 0.0 ? 2 : 1, CoverageOptions());
    feed(wave.recording, 5.0, &half);
    const CoverageReport early = half.report();
    EXPECT_FALSE(early.enough());
    EXPECT_SAYS(missing(early), "wave on for");
    EXPECT_NEAR(early.seconds, 5.0, 0.6);
    // True speed of the LED, or of the wand's middle.
    std::vector<double> speeds;
    for (double t = 0.0; t < scene.duration; t += 0.01) {
      Eigen::Vector3d velocity = wave.path.velocity(t, 0);
      if (length > 0.0)
        velocity = 0.5 * (velocity + wave.path.velocity(t, 1));
      speeds.push_back(velocity.norm());
    }
    std::nth_element(speeds.begin(), speeds.begin() + speeds.size() / 2, speeds.end());

    Coverage coverage(wave.cameras, true, length > 0.0 ? 2 : 1, CoverageOptions());
    feed(wave.recording, scene.duration, &coverage);
    const CoverageReport report = coverage.report();
    EXPECT_TRUE(report.enough()) << missing(report);
    ASSERT_TRUE(report.speed && report.volume && early.volume);
    EXPECT_NEAR(*report.speed / speeds[speeds.size() / 2], 1.0, 0.1);
    EXPECT_GT(*report.volume, *early.volume);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_GE(report.cameras[i].image_share, early.cameras[i].image_share);
      EXPECT_GT(report.cameras[i].together, 20.0);
    }
  }
}

TEST(Coverage, WhatIsJustTooLittleIsShownBelowTheWanted) {
  const SimulatedWave wave = simulateWave(WaveScene(), 2);
  const auto reportWith = [&](const CoverageOptions& options) {
    Coverage coverage(wave.cameras, true, 1, options);
    feed(wave.recording, 100.0, &coverage);
    return coverage.report();
  };
  CoverageOptions options;
  const CoverageReport report = reportWith(options);
  ASSERT_TRUE(report.speed && report.volume);
  options.volume = *report.volume + 0.001;
  options.speed = *report.speed + 0.001;
  const auto shown = [](double value) { return 0.01 * std::floor(100.0 * value); };
  const std::string said = missing(reportWith(options));
  EXPECT_SAYS(said, format("been in %.2f of %g cubic", shown(*report.volume), options.volume));
  EXPECT_SAYS(
      said, format("at %.2f m/s: wave it faster than %g m/s", shown(*report.speed), options.speed));
}

TEST(Coverage, WithoutKnownCamerasThereIsNoVolume) {
  const SimulatedWave wave = simulateWave(WaveScene(), 3);
  Coverage coverage(wave.cameras, false, 1, CoverageOptions());
  feed(wave.recording, 100.0, &coverage);
  const CoverageReport report = coverage.report();
  EXPECT_FALSE(report.volume.has_value());
  EXPECT_FALSE(report.speed.has_value());
  EXPECT_GT(report.cameras[0].image_speed, 100.0);
}

TEST(Coverage, SaysWhichPartOfTheImageIsEmpty) {
  // A spot that sweeps the whole image but its lower third.
  CoverageOptions options;
  options.image_share = 0.9;
  Coverage coverage({geometry::Camera(), geometry::Camera()}, false, 1, options);
  for (double time = 0.0; time < 30.0; time += 0.01) {
    Frame frame;
    frame.stamp = time;
    frame.spots = {Eigen::Vector2d(512.0 + 505.0 * std::sin(2.0 * time), 16.0 * time)};
    coverage.add(0, frame);
    coverage.add(1, frame);
  }
  const CoverageReport report = coverage.report();
  EXPECT_SAYS(missing(report), "wave it at the bottom");
  EXPECT_NEAR(report.cameras[0].image_share, 4.0 / 6.0, 0.05);
  EXPECT_NEAR(report.seconds, 29.9, 0.25);
}

TEST(Coverage, CamerasThatSeeTheLedOneAfterTheOtherAreNamed) {
  std::vector<geometry::Camera> cameras(2);
  cameras[0].name = "left";
  cameras[1].name = "right";
  Coverage coverage(cameras, false, 1, CoverageOptions());
  for (double time = 0.0; time < 40.0; time += 0.01) {
    Frame frame;
    frame.stamp = time;
    frame.spots = {Eigen::Vector2d(512.0 + 500.0 * std::sin(2.0 * time),
                                   384.0 + 370.0 * std::sin(0.7 * time))};
    coverage.add(time < 20.0 ? 0 : 1, frame);
  }
  const CoverageReport report = coverage.report();
  for (const std::string name : {"left", "right"})
    EXPECT_SAYS(missing(report), name + " and another camera have seen the LED together for 0 s");
  EXPECT_LT(report.seconds, 0.15);
  EXPECT_FALSE(report.enough());
}

TEST(Coverage, SlowWavesLampsAndBlindCamerasAreNamed) {
  WaveScene scene;
  scene.duration = 30.0;
  scene.lamp = true;
  std::mt19937_64 random(5);
  SimulatedPath path(0.0, random);
  path.pace = 0.25;
  SimulatedWave wave = simulateWave(scene, path, random);
  for (Frame& frame : wave.recording.cameras[3].frames)
    frame.spots = {Eigen::Vector2d(300.0, 200.0)};
  Coverage coverage(wave.cameras, true, 1, CoverageOptions());
  feed(wave.recording, 100.0, &coverage);
  const CoverageReport report = coverage.report();
  EXPECT_SAYS(missing(report), "wave it faster");
  EXPECT_SAYS(missing(report), "camera_1 sees other lights");
  EXPECT_SAYS(missing(report), "camera_4 has not seen the LED move");
  EXPECT_EQ(report.cameras[3].image_share, 0.0);
  EXPECT_GT(report.cameras[0].distraction, 0.5);
}

}  // namespace
}  // namespace wiimote_tracker::wave
