// More LEDs than the cameras report: each shows four.
#include "tracking/tracker_runs.h"

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
  std::size_t wrong = 0;
  double stddev = 0.0;  // sum of their own [m]
};

/// Adds the tracked points of one run; wrong: farther than 50 mm and five standard deviations from
/// every LED.
void addRun(const std::vector<Path>& leds,
            SceneOptions options,
            unsigned seed,
            Points* points,
            const TrackerOptions& tracker_options = exactOptions()) {
  options.merging_distance = 24.0;
  Tracker tracker(paperRig(), tracker_options);
  for (const Snapshot& snapshot :
       track(&tracker, imagesOf(paperRig(), leds, options, kImages, seed))) {
    for (const TrackedLed& point : snapshot.leds) {
      if (point.state != TrackState::kTracked)
        continue;
      const double stddev = std::sqrt(point.position_covariance.trace());
      const double allowed = std::max(0.05, 5.0 * stddev);
      ++points->tracked;
      points->stddev += stddev;
      points->wrong += std::none_of(leds.begin(), leds.end(), [&](const Path& led) {
        return (led(snapshot.time) - point.position).norm() <= allowed;
      });
    }
  }
}

// Three LEDs move among thirteen that the cameras hardly show. Where an unknown LED merges with one
// of them, its point is drawn aside, by more than its covariance said for 0.3 % of all points.
TEST(TrackerCrowds, TheCovarianceAllowsForUnknownLedsThatMerge) {
  constexpr std::pair<double, double> kMiddles[] = {{0.4, 0.4}, {2.1, 0.6}, {1.2, 2.1}};  // [m]
  SceneOptions options;
  options.equally_bright = true;
  options.hidden = [](std::size_t, std::size_t led, double time) {
    return led >= 3 && time < 1001.0 + 0.005 * static_cast<double>(led);
  };
  Points all;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    geometry::test::Random random(seed);
    std::vector<Path> leds;
    for (const auto& [x, y] : kMiddles)
      leds.push_back(wandering(random, {x, y, 1.0}, 0.25, 0.4));
    for (int i = 0; i < 13; ++i)
      leds.push_back(still({0.3 + 0.6 * (i % 4), 0.3 + 0.6 * (i / 4), 0.5 + 0.1 * (5 * i % 13)}));
    addRun(leds, options, seed, &all);
  }
  EXPECT_GT(all.tracked, 80000u);
  EXPECT_LT(all.stddev / all.tracked, 0.03);
  EXPECT_LE(all.wrong, 3e-4 * all.tracked) << all.tracked;
}

TEST(TrackerCrowds, ItStaysExactWhereAllLedsAreKnown) {
  Points all;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    geometry::test::Random random(seed);
    std::vector<Path> leds;
    for (int i = 0; i < 5; ++i)
      leds.push_back(wandering(random, {0.5 + 0.5 * (i % 4), 0.6 + 0.6 * (i / 4), 1.0}, 0.2, 0.5));
    addRun(leds, SceneOptions(), seed, &all);
  }
  EXPECT_GT(all.tracked, 5u * 4 * kImages * 98 / 100);
  EXPECT_LT(all.stddev / all.tracked, 0.003);
}

// Three LEDs and a reflection fill the images, but hide nobody.
TEST(TrackerCrowds, ItStaysExactBesideALightThatIsLeftOut) {
  Points all;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    geometry::test::Random random(seed);
    std::vector<Path> leds;
    for (int i = 0; i < 3; ++i)
      leds.push_back(wandering(random, {0.6 + 0.6 * i, 0.8 + 0.3 * i, 1.0}, 0.2, 0.5));
    leds.push_back(still({1.2, 1.2, 0.1}));
    TrackerOptions options = exactOptions();
    options.minimum_corner.z() = 0.3;
    addRun(leds, SceneOptions(), seed, &all, options);
  }
  EXPECT_GT(all.tracked, 3u * 4 * kImages * 98 / 100);
  EXPECT_LT(all.stddev / all.tracked, 0.004);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
