// More LEDs than the cameras report: each shows four.
#include "tracking/tracker_runs.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr int kImages = 4000;  // of each run

struct Points {
  std::size_t tracked = 0;
  std::size_t wrong = 0;  // farther than 50 mm and five standard deviations from every LED
  double stddev = 0.0;    // mean of their own [m]
};

struct Situation {
  geometry::Rig seen_by = paperRig();  // the tracker knows paperRig()
  std::vector<Path> leds;
  SceneOptions scene;
  TrackerOptions tracker = exactOptions();
};

Points pointsIn(Situation situation, unsigned seed) {
  situation.scene.merging_distance = 24.0;
  Tracker tracker(paperRig(), situation.tracker);
  Points points;
  for (const Snapshot& snapshot : track(
           &tracker, imagesOf(situation.seen_by, situation.leds, situation.scene, kImages, seed))) {
    for (const TrackedLed& point : snapshot.leds) {
      if (point.state != TrackState::kTracked)
        continue;
      const double stddev = std::sqrt(point.position_covariance.trace());
      const double allowed = std::max(0.05, 5.0 * stddev);
      ++points.tracked;
      points.stddev += (stddev - points.stddev) / points.tracked;
      points.wrong += std::none_of(
          situation.leds.begin(), situation.leds.end(),
          [&](const Path& led) { return (led(snapshot.time) - point.position).norm() <= allowed; });
    }
  }
  return points;
}

/// LEDs that move through parts of the room of their own.
std::vector<Path> movingLeds(std::size_t count, unsigned seed) {
  constexpr std::pair<double, double> kMiddles[] = {
      {0.4, 0.4}, {2.1, 0.6}, {1.2, 2.1}, {0.5, 1.5}, {1.9, 1.5}};  // [m]
  geometry::test::Random random(seed);
  std::vector<Path> leds;
  for (std::size_t i = 0; i < count; ++i)
    leds.push_back(wandering(random, {kMiddles[i].first, kMiddles[i].second, 1.0}, 0.25, 0.4));
  return leds;
}

/// Three LEDs that move among thirteen others.
Situation amongStillLeds(unsigned seed) {
  Situation situation;
  situation.leds = movingLeds(3, seed);
  for (int i = 0; i < 13; ++i) {
    const int row = i / 4;
    situation.leds.push_back(
        still({0.3 + 0.6 * (i % 4), 0.3 + 0.6 * row, 0.5 + 0.1 * (5 * i % 13)}));
  }
  situation.scene.equally_bright = true;
  return situation;
}

// Three LEDs move among thirteen that the cameras hardly show. Where an unknown LED merges with one
// of them, its point is drawn aside, by more than its filter's covariance says for 0.3 % of all.
TEST(TrackerCrowds, TheCovarianceAllowsForUnknownLedsThatMerge) {
  std::size_t tracked = 0;
  std::size_t wrong = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Situation situation = amongStillLeds(seed);
    situation.scene.hidden = [](std::size_t, std::size_t led, double time) {
      return led >= 3 && time < 1001.0 + 0.005 * static_cast<double>(led);
    };
    const Points points = pointsIn(situation, seed);
    tracked += points.tracked;
    wrong += points.wrong;
    EXPECT_LT(points.stddev, 0.06);
  }
  EXPECT_GT(tracked, 80000u);
  EXPECT_LE(wrong, 3e-5 * tracked) << tracked;
}

// They shine for 1.5 s and are out for 0.5 s. Once they are out, no camera is full, but the filters
// have not yet forgotten a merged spot. While they shine, facing cameras show different LEDs.
TEST(TrackerCrowds, ItStaysRightWhileUnknownLedsGoOnAndOut) {
  std::size_t tracked = 0;
  std::size_t wrong = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Situation situation = amongStillLeds(seed);
    situation.scene.hidden = [](std::size_t, std::size_t led, double time) {
      return led >= 3 && std::fmod(time - 0.003 * static_cast<double>(led), 2.0) < 0.5;
    };
    const Points points = pointsIn(situation, seed);
    tracked += points.tracked;
    wrong += points.wrong;
  }
  EXPECT_GT(tracked, 70000u);
  EXPECT_LE(wrong, 3e-5 * tracked) << tracked;
}

void expectExact(const Situation& situation, std::size_t leds, unsigned seed) {
  const Points points = pointsIn(situation, seed);
  EXPECT_GT(points.tracked, leds * kImages * 94 / 100) << seed;
  EXPECT_LT(points.stddev, 0.004) << seed;
}

TEST(TrackerCrowds, ItStaysExactWhereAllLedsAreKnown) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Situation situation;
    situation.leds = movingLeds(5, seed);
    expectExact(situation, 5, seed);
  }
}

// They fill the images, but hide nobody.
TEST(TrackerCrowds, ItStaysExactWithThreeLedsAndAReflection) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Situation situation;
    situation.leds = movingLeds(3, seed);
    situation.leds.push_back(still({1.2, 1.2, 0.1}));
    situation.tracker.minimum_corner.z() = 0.3;
    expectExact(situation, 3, seed);
  }
}

TEST(TrackerCrowds, ItStaysExactWithALampBeforeOneCamera) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Situation situation;
    situation.leds = movingLeds(4, seed);
    situation.scene.reflections = {{{100.0, 100.0}, {900.0, 100.0}}};
    expectExact(situation, 4, seed);
  }
}

TEST(TrackerCrowds, ItStaysExactBesideFalseDetections) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Situation situation;
    situation.leds = movingLeds(4, seed);
    situation.scene.ghosts = 1.0;
    situation.scene.dropout = 0.1;
    expectExact(situation, 4, seed);
  }
}

TEST(TrackerCrowds, ItStaysExactBesideAMovedCamera) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Situation situation;
    situation.leds = movingLeds(4, seed);
    Eigen::Isometry3d& pose = situation.seen_by.cameras[0].camera.world_from_camera;
    pose.rotate(Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY()));
    expectExact(situation, 4, seed);
  }
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
