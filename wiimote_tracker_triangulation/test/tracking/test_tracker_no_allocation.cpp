// A warmed-up tracker takes images and gives snapshots without allocating.
#include "allocation_counter.h"
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

TEST(TrackerNoAllocation, TheCounterCounts) {
  const int before = g_allocations;
  const auto something = std::make_unique<std::vector<int>>(3);
  EXPECT_EQ(3u, something->size());
  EXPECT_EQ(before + 2, g_allocations);
}

/// Allocations in `count` images, after as many for warm-up.
int allocations(const SceneOptions& options, int count) {
  Scene scene(paperRig(), wanderers(4, 3), options, 5);
  std::vector<SceneImage> images;
  for (int i = 0; i < 2 * count; ++i)
    images.push_back(scene.next());
  TrackerOptions tracker_options;
  tracker_options.pixel_stddev = options.pixel_noise;
  Tracker tracker(paperRig(), tracker_options);
  int before = 0;
  std::size_t leds_seen = 0;
  std::size_t merged = 0;  // spots in the images that count
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (i == images.size() / 2)
      before = g_allocations;
    for (const std::uint64_t leds : images[i].leds_of_spot)
      merged += i >= images.size() / 2 && (leds & (leds - 1)) != 0;
    tracker.add(images[i].camera, images[i].image);
    while (const Snapshot* snapshot = tracker.next())
      leds_seen += snapshot->leds.size();
  }
  const int result = g_allocations - before;
  EXPECT_GT(leds_seen, images.size() * 2);
  EXPECT_EQ(options.merging_distance > 0.0, merged > 0);
  EXPECT_EQ(options.delay_jitter > 0.0, tracker.counters().late > 0);
  return result;
}

TEST(TrackerNoAllocation, ImagesInOrder) {
  EXPECT_EQ(0, allocations(SceneOptions(), 1000));
}

TEST(TrackerNoAllocation, MergedSpots) {
  SceneOptions options;
  options.merging_distance = 24.0;
  EXPECT_EQ(0, allocations(options, 4000));
}

TEST(TrackerNoAllocation, LateImages) {
  SceneOptions options;
  options.delay_jitter = 0.003;
  EXPECT_EQ(0, allocations(options, 1000));
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
