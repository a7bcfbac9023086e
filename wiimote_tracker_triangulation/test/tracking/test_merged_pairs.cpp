// Two LEDs merge into one spot in all views at once, and part again.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// Two LEDs, of which one comes, rests beside the other one, and one of both leaves.
std::vector<Path> resting(geometry::test::Random& random) {
  const Eigen::Vector3d place = Eigen::Vector3d(1.25, 1.25, 1.0) + random.inBox(0.3);
  const Eigen::Vector3d from = 0.5 * random.inBox(1.0).normalized();
  const Eigen::Vector3d to = 0.5 * random.inBox(1.0).normalized();
  const bool is_same = random.uniform(0.0, 1.0) < 0.5;
  const auto way = [](double since) { return since < 0.0 ? 0.0 : std::min(1.0, since * since); };
  const auto coming = [=](double t) {
    return Eigen::Vector3d(place + way(kMeeting - 0.5 - t) * from);
  };
  const auto leaving = [=](double t) { return Eigen::Vector3d(way(t - kMeeting - 0.5) * to); };
  return {[=](double t) { return Eigen::Vector3d(coming(t) + is_same * leaving(t)); },
          [=](double t) { return Eigen::Vector3d(place + !is_same * leaving(t)); }};
}

/// What the last snapshot before a time [s] shows.
struct Followed {
  std::vector<std::int64_t> ids = {-1, -1};
  double same_led_probability = 1.0;  // the least of both
};

Followed follow(Tracker* tracker,
                Scene* scene,
                double end,
                std::set<std::size_t>* merged = nullptr) {
  Followed last;
  for (;;) {
    const SceneImage& image = scene->next();
    if (image.true_time >= end)
      return last;
    if (merged && image.leds_of_spot == std::vector<std::uint64_t>{3})
      merged->insert(image.camera);
    tracker->add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker->next()) {
      last.ids = idsAt(*snapshot, scene->leds(), 0.05);
      last.same_led_probability = 1.0;
      for (const TrackedLed& led : snapshot->leds)
        last.same_led_probability = std::min(last.same_led_probability, led.same_led_probability);
    }
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
    const auto before = follow(&tracker, &scene, kMeeting - 0.2).ids;
    EXPECT_NE(-1, before[0]);
    EXPECT_NE(-1, before[1]);
    const Followed after = follow(&tracker, &scene, kMeeting + 0.5, &merged);
    EXPECT_EQ(before, after.ids) << i;
    EXPECT_GT(after.same_led_probability, 0.99) << i;
    EXPECT_EQ(4u, merged.size());
  }
}

TEST(MergedPairs, AreDoubtfulWhenNothingTellsThem) {
  const geometry::Rig rig = paperRig();
  geometry::test::Random random(8);
  for (int i = 0; i < 20; ++i) {
    Scene scene(rig, resting(random), merging(), 200 + i);
    Tracker tracker(rig, exactOptions());
    const Followed apart = follow(&tracker, &scene, kMeeting - 1.0);
    EXPECT_NE(-1, apart.ids[0]);
    EXPECT_NE(-1, apart.ids[1]);
    EXPECT_EQ(1.0, apart.same_led_probability);
    EXPECT_NEAR(0.5, follow(&tracker, &scene, kMeeting + 1.5).same_led_probability, 0.05) << i;
  }
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
