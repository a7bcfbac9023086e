// Two LEDs merge into one spot in all views at once, and part again.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr double kMeeting = 1001.0;  // [s]

SceneOptions merging() {
  SceneOptions options;
  options.start = kMeeting - 1.5;
  options.merging_distance = 8.0;
  return options;
}

/// Two LEDs that pass each other within some millimetres, each with a steady acceleration.
std::vector<Path> passing(geometry::test::Random& random, double speed) {
  std::vector<Path> leds;
  const Eigen::Vector3d relative = 0.5 * speed * random.inBox(1.0).normalized();
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d place = Eigen::Vector3d(1.25, 1.25, 1.0) + random.inBox(0.003);
    const Eigen::Vector3d velocity = sign * relative;
    const Eigen::Vector3d acceleration = random.inBox(1.5);
    leds.push_back([=](double t) {
      const double since = t - kMeeting;
      return Eigen::Vector3d(place + since * velocity + 0.5 * since * since * acceleration);
    });
  }
  return leds;
}

/// Ids at the last snapshot before a time [s].
std::vector<std::int64_t> follow(Tracker* tracker,
                                 Scene* scene,
                                 double end,
                                 std::set<std::size_t>* merged = nullptr) {
  std::vector<std::int64_t> ids = {-1, -1};
  for (;;) {
    const SceneImage& image = scene->next();
    if (image.true_time >= end)
      return ids;
    if (merged && image.leds_of_spot == std::vector<std::uint64_t>{3})
      merged->insert(image.camera);
    tracker->add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker->next())
      ids = idsAt(*snapshot, scene->leds(), 0.05);
  }
}

TEST(MergedPairs, KeepTheirIdsByTheirMotion) {
  // Their merged spot is 4 px from either when they meet, further than the gate of each.
  const geometry::Rig rig = paperRig();
  geometry::test::Random random(7);
  for (int i = 0; i < 30; ++i) {
    Scene scene(rig, passing(random, 0.4), merging(), 100 + i);
    Tracker tracker(rig, exactOptions());
    std::set<std::size_t> merged;
    const auto before = follow(&tracker, &scene, kMeeting - 0.2);
    EXPECT_NE(-1, before[0]);
    EXPECT_NE(-1, before[1]);
    EXPECT_EQ(before, follow(&tracker, &scene, kMeeting + 0.5, &merged)) << i;
    EXPECT_EQ(4u, merged.size());
  }
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
