// LEDs keep their ids through occlusion, merged spots, jumps and blinking.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

TEST(Tracker, AHiddenLedIsPredictedAndKeepsItsId) {
  const std::vector<Path> leds = {circle({1.25, 1.25, 1.0}, 0.4, 0.5)};
  SceneOptions options;
  options.hidden = [](std::size_t, std::size_t, double t) { return t > 1001.0 && t < 1001.25; };
  Tracker tracker(paperRig(), exactOptions());
  bool predicted = false, tracked_again = false;
  for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), leds, options, 1000))) {
    if (s.time < 1000.5)
      continue;
    ASSERT_EQ(1u, s.leds.size());
    EXPECT_EQ(0u, s.leds[0].id);
    const bool is_predicted = s.leds[0].state == TrackState::kPredicted;
    if (s.time < 1001.0 || s.time > 1001.3) {
      EXPECT_EQ(TrackState::kTracked, s.leds[0].state) << s.time;
      tracked_again |= s.time > 1001.3;
    }
    if (s.time > 1001.07 && s.time < 1001.24) {
      EXPECT_TRUE(is_predicted) << s.time;
      predicted = true;
    }
    if (is_predicted && s.time > 1001.07) {
      EXPECT_TRUE(s.leds[0].cameras.empty());
      EXPECT_TRUE(std::isnan(s.leds[0].residual));
      EXPECT_LE(s.leds[0].last_observed, 1001.0);
    }
  }
  EXPECT_TRUE(predicted && tracked_again);
}

TEST(Tracker, AnLedSeenByOneCameraIsPredicted) {
  const std::vector<Path> leds = {circle({1.25, 1.25, 1.0}, 0.4, 0.5)};
  SceneOptions options;
  options.hidden = [](std::size_t camera, std::size_t, double t) {
    return camera != 2 && t > 1001.0 && t < 1001.4;
  };
  const TrackerOptions tracker_options = exactOptions();
  Tracker tracker(paperRig(), tracker_options);
  std::size_t alone = 0, tracked = 0;
  for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), leds, options, 1000))) {
    if (s.time < 1000.5)
      continue;
    ASSERT_EQ(1u, s.leds.size());
    const TrackedLed& led = s.leds[0];
    EXPECT_EQ(0u, led.id);
    if (s.time > 1001.0 + tracker_options.tracked_time && s.time < 1001.4) {
      EXPECT_EQ(TrackState::kPredicted, led.state) << s.time;
      EXPECT_EQ(CameraList{2}, led.cameras);
      EXPECT_LE(s.time - led.last_observed, 0.011) << "one image";
      ++alone;
    } else if (s.time < 1001.0 || s.time > 1001.41) {
      EXPECT_EQ(TrackState::kTracked, led.state) << s.time;
      ++tracked;
    }
  }
  EXPECT_GT(alone, 100u);
  EXPECT_GT(tracked, 400u);
}

TEST(Tracker, AnLedHiddenForLongIsLostOnceAndGetsANewId) {
  const std::vector<Path> leds = wanderers(2, 11);
  SceneOptions options;
  options.hidden = [](std::size_t, std::size_t led, double t) {
    return led == 1 && t > 1001.0 && t < 1003.0;
  };
  Tracker tracker(paperRig(), exactOptions());
  int lost = 0;
  std::vector<Snapshot> snapshots = track(&tracker, imagesOf(paperRig(), leds, options, 1800));
  for (const Snapshot& snapshot : snapshots) {
    const std::set<std::uint32_t> ids = idsIn(snapshot, TrackState::kLost);
    lost += static_cast<int>(ids.size());
    if (!ids.empty()) {
      EXPECT_NEAR(1001.5, snapshot.time, 0.02);
    }
  }
  EXPECT_EQ(1, lost);
  const std::set<std::uint32_t> at_end = idsIn(snapshots.back(), TrackState::kTracked);
  EXPECT_EQ(2u, at_end.size());
  EXPECT_TRUE(at_end.count(2));
}

TEST(Tracker, AnLedSeenByOneCameraForLongIsLost) {
  SceneOptions options;
  options.hidden = [](std::size_t camera, std::size_t, double t) {
    return camera != 2 && t > 1001.0;
  };
  const TrackerOptions tracker_options = exactOptions();
  Tracker tracker(paperRig(), tracker_options);
  const std::vector<Snapshot> snapshots =
      track(&tracker, imagesOf(paperRig(), {still({1.25, 1.25, 1.0})}, options, 1000));
  int lost = 0;
  for (const Snapshot& s : snapshots) {
    if (idsIn(s, TrackState::kLost).empty())
      continue;
    ++lost;
    EXPECT_NEAR(1001.0 + tracker_options.tracked_time + tracker_options.single_view_time, s.time,
                0.02);
  }
  EXPECT_EQ(1, lost);
  EXPECT_TRUE(snapshots.back().leds.empty());
}

TEST(Tracker, TwoLedsMergedInOneViewKeepTheirIds) {
  // They pass each other on the line of sight of the first camera, 0.3 m apart.
  const geometry::Rig rig = paperRig();
  const geometry::Camera& camera = rig.cameras[0].camera;
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  const Eigen::Vector3d along = (middle - camera.center()).normalized();
  const Eigen::Vector3d across = along.cross(Eigen::Vector3d::UnitZ()).normalized();
  const std::vector<Path> leds = {straight(middle - 0.15 * along, 0.3 * across, 1001.0),
                                  straight(middle + 0.15 * along, -0.3 * across, 1001.0)};
  SceneOptions options;
  options.merging_distance = 8.0;
  const std::vector<SceneImage> images = imagesOf(rig, leds, options, 800);
  EXPECT_TRUE(std::any_of(images.begin(), images.end(), [](const SceneImage& image) {
    return image.camera == 0 && image.leds_of_spot == std::vector<std::uint64_t>{3};
  }));
  Tracker tracker(rig, exactOptions());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, images)) {
    if (snapshot.time > 1000.5)
      check.add(snapshot);
  }
  EXPECT_EQ(0u, check.switches);
  EXPECT_EQ(0u, check.renamed);
  EXPECT_EQ(0u, check.uncovered);
}

TEST(Tracker, TwoLedsMergedInAllViewsKeepTheirIdsByTheirMotion) {
  // They pass each other 1 cm apart, which no view resolves.
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  for (const double speed : {0.3, 0.6, 1.2}) {
    const Eigen::Vector3d velocity = speed * Eigen::Vector3d(0.6, 0.0, 0.8);
    const std::vector<Path> leds = {
        straight(middle, velocity, 1001.5),
        straight(middle + Eigen::Vector3d(0.0, 0.01, 0.0), -velocity, 1001.5)};
    SceneOptions options;
    options.merging_distance = 8.0;
    options.start = 1001.1;
    const std::vector<SceneImage> images = imagesOf(paperRig(), leds, options, 320);
    std::set<std::size_t> merged;
    for (const SceneImage& image : images) {
      if (image.leds_of_spot == std::vector<std::uint64_t>{3})
        merged.insert(image.camera);
    }
    EXPECT_EQ(4u, merged.size());
    Tracker tracker(paperRig(), exactOptions());
    IdentityCheck check(leds);
    for (const Snapshot& snapshot : track(&tracker, images)) {
      if (snapshot.time > 1001.3)
        check.add(snapshot);
    }
    EXPECT_EQ(0u, check.switches) << speed;
    EXPECT_EQ(0u, check.renamed) << speed;
    EXPECT_GT(check.near, check.snapshots) << "both are tracked most of the time";
    EXPECT_GT(check.snapshots, 200u);
  }
}

// It blinks at the height of the cameras. The first two that see it again may face each other:
// their rays hardly determine its position along their line, its motion does.
TEST(Tracker, ABlinkingLedKeepsItsMotionWhileItIsDark) {
  const Path led = circle({1.25, 1.25, 1.9}, 0.4, 0.5);
  SceneOptions options;
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 0.3) < 0.2; };
  const auto rmsWith = [&](double dark_time) {
    TrackerOptions tracker_options = exactOptions();
    tracker_options.dark_time = dark_time;
    double squares = 0.0;
    int count = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {  // another order of the cameras each
      Tracker tracker(paperRig(), tracker_options);
      for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), {led}, options, 1200, seed))) {
        if (s.time < options.start + 1.0)
          continue;
        EXPECT_EQ(1u, s.leds.size());
        EXPECT_EQ(0u, s.leds.at(0).id);
        if (s.leds[0].state == TrackState::kTracked) {
          squares += (s.leds[0].position - led(s.time)).squaredNorm();
          ++count;
        }
      }
    }
    EXPECT_GT(count, 3000);
    return std::sqrt(squares / count);
  };
  const double known = rmsWith(0.3);
  EXPECT_LT(known, 0.0013);
  EXPECT_LT(known, 0.7 * rmsWith(0.0));
}

TEST(Tracker, AnLedThatJumpsIsNeverTrackedAtTheWrongPlace) {
  // In each step of 0.25 s it is somewhere else; seldom so near that it may have gone there.
  geometry::test::Random random(21);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 40; ++i)
    places.emplace_back(random.uniform(0.6, 1.9), random.uniform(0.6, 1.9),
                        random.uniform(0.6, 1.6));
  const Path led = [&](double t) {
    return places[static_cast<std::size_t>((t - 1000.0) / 0.25) % places.size()];
  };
  SceneOptions options;
  options.maximum_spots = 1;  // so no image says that the LED is not where it was
  Tracker tracker(paperRig(), exactOptions());
  std::size_t in_time = 0;
  for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), {led}, options, 3900))) {
    const double since_leap = std::fmod(s.time - 1000.0, 0.25);
    bool covered = false;
    for (const TrackedLed& track : s.leds) {
      // Some of the first images after a jump may also fit the old position.
      if (track.state != TrackState::kTracked || track.last_observed < s.time || since_leap < 0.06)
        continue;
      const double error = (track.position - led(s.time)).norm();
      EXPECT_LT(error, 6.0 * std::sqrt(track.position_covariance.trace())) << s.time;
      covered = true;
    }
    in_time += covered;
  }
  EXPECT_GT(in_time, 3900u * 19 / 25 * 95 / 100);
}

TEST(Tracker, ATrackThatLostItsLedReacquiresItWithItsId) {
  // A jump that no mode allows, and spots that are not the LED's.
  for (const double jump : {0.02, 0.04, 0.06}) {
    const Path led = [&](double t) {
      return Eigen::Vector3d(1.2 + (t > 1001.0 ? jump : 0.0), 1.3, 1.0);
    };
    Tracker tracker(paperRig(), exactOptions());
    std::set<std::uint32_t> ids;
    for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), {led}, {}, 800))) {
      for (const std::uint32_t id : idsIn(s, TrackState::kTracked))
        ids.insert(id);
      if (s.time > 1001.05) {
        ASSERT_EQ(1u, s.leds.size());
        EXPECT_LT((s.leds[0].position - led(s.time)).norm(),
                  6.0 * std::sqrt(s.leds[0].position_covariance.trace()));
      }
    }
    EXPECT_EQ((std::set<std::uint32_t>{0}), ids) << jump;
  }
}

TEST(Tracker, OfTwoTracksThatShareAllSpotsOneEnds) {
  // They meet, and from then on there is only one light.
  const std::vector<Path> leds = {still({1.25, 1.25, 1.0}), [](double t) {
                                    return Eigen::Vector3d(
                                        1.25, 1.25, 1.0 + std::max(0.004, 0.2 * (1001.0 - t)));
                                  }};
  SceneOptions options;
  options.merging_distance = 8.0;
  Tracker tracker(paperRig(), exactOptions());
  const std::vector<Snapshot> snapshots =
      track(&tracker, imagesOf(paperRig(), leds, options, 2000));
  // Not before two LEDs that pass each other slowly would have parted.
  for (const Snapshot& s : snapshots) {
    if (s.time > 1000.2 && s.time < 1001.2) {
      EXPECT_EQ(2u, s.leds.size()) << s.time;
    }
  }
  EXPECT_EQ((std::set<std::uint32_t>{0}), idsIn(snapshots.back(), TrackState::kTracked));
  EXPECT_EQ(1u, snapshots.back().leds.size());
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
