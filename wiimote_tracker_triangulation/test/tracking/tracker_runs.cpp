#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace wiimote_tracker::tracking::test {

std::vector<SceneImage> imagesOf(const geometry::Rig& rig,
                                 const std::vector<Path>& leds,
                                 const SceneOptions& options,
                                 int count,
                                 unsigned seed) {
  Scene scene(rig, leds, options, seed);
  std::vector<SceneImage> images;
  for (int i = 0; i < count; ++i)
    images.push_back(scene.next());
  return images;
}

std::vector<Snapshot> track(Estimator* tracker, const std::vector<SceneImage>& images) {
  std::vector<Snapshot> snapshots;
  for (const SceneImage& image : images) {
    tracker->add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker->next())
      snapshots.push_back(*snapshot);
  }
  return snapshots;
}

Snapshot stateAt(Tracker& tracker, double time) {
  Snapshot snapshot;
  EXPECT_TRUE(tracker.predictTo(time, &snapshot));
  return snapshot;
}

void expectSameLeds(Snapshot a, Snapshot b) {
  ASSERT_FALSE(a.leds.empty());
  ASSERT_EQ(a.leds.size(), b.leds.size());
  for (Snapshot* snapshot : {&a, &b}) {
    std::sort(snapshot->leds.begin(), snapshot->leds.end(),
              [](auto& c, auto& d) { return c.position.x() < d.position.x(); });
  }
  for (std::size_t i = 0; i < a.leds.size(); ++i) {
    EXPECT_EQ(a.leds[i].state, b.leds[i].state);
    EXPECT_EQ(a.leds[i].position, b.leds[i].position);
    EXPECT_EQ(a.leds[i].position_covariance, b.leds[i].position_covariance);
    EXPECT_EQ(*a.leds[i].velocity, *b.leds[i].velocity);
    EXPECT_EQ(a.leds[i].cameras, b.leds[i].cameras);
  }
}

std::set<std::uint32_t> idsIn(const Snapshot& snapshot, TrackState state) {
  std::set<std::uint32_t> ids;
  for (const TrackedLed& led : snapshot.leds) {
    if (led.state == state)
      ids.insert(led.id);
  }
  return ids;
}

}  // namespace wiimote_tracker::tracking::test
