// LEDs keep their identities through what happens in a room, and images may come as they like.
#include "tracking/identity_check.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"
#include "wiimote_tracker_triangulation/tracking/make_estimator.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking {
namespace {

using test::IdentityCheck;
using test::paperRig;
using test::Path;
using test::Scene;
using test::SceneImage;
using test::SceneOptions;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TrackerOptions exact() {
  TrackerOptions options;
  options.pixel_stddev = 0.3;  // the scene's
  options.stamp_stddev = 0.0;
  return options;
}

std::vector<Path> wanderers(int count, unsigned seed, double speed = 1.0) {
  geometry::test::Random random(seed);
  std::vector<Path> leds;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center(i % 2 ? 1.7 : 0.8, i / 2 ? 1.7 : 0.8, 1.0);
    leds.push_back(test::wandering(random, center, 0.25, speed));
  }
  return leds;
}

std::vector<SceneImage> imagesOf(const geometry::Rig& rig,
                                 const std::vector<Path>& leds,
                                 const SceneOptions& options,
                                 int count,
                                 unsigned seed = 1) {
  Scene scene(rig, leds, options, seed);
  std::vector<SceneImage> images;
  for (int i = 0; i < count; ++i)
    images.push_back(scene.next());
  return images;
}

/// Adds images and keeps the snapshots.
std::vector<Snapshot> track(Estimator* tracker, const std::vector<SceneImage>& images) {
  std::vector<Snapshot> snapshots;
  for (const SceneImage& image : images) {
    tracker->add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker->next())
      snapshots.push_back(*snapshot);
  }
  return snapshots;
}

Snapshot stateAt(const Tracker& tracker, double time) {
  Snapshot snapshot;
  EXPECT_TRUE(tracker.predictTo(time, &snapshot));
  return snapshot;
}

/// Bit for bit, but for the ids and so for the order.
void expectSameLeds(Snapshot a, Snapshot b) {
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

TEST(Tracker, FourLedsAreFoundAndKept) {
  const std::vector<Path> leds = wanderers(4, 5);
  SceneOptions options;
  options.dropout = 0.1;
  options.ghosts = 1.0;
  options.merging_distance = 8.0;
  Tracker tracker(paperRig(), exact());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), leds, options, 4000))) {
    if (snapshot.time > options.start + 0.5)
      check.look(snapshot);
  }
  EXPECT_EQ(0u, check.switches);
  EXPECT_EQ(0u, check.renamed);
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_EQ(0u, check.false_tracks);
  EXPECT_GT(check.snapshots, 3700u);
}

TEST(Tracker, AStillLedIsLocatedBetterThanByOneImageOfEachCamera) {
  const geometry::Rig rig = paperRig();
  const Eigen::Vector3d place(1.1, 1.4, 0.9);
  Tracker tracker(rig, exact());
  double squares = 0.0;
  int count = 0;
  for (const Snapshot& s :
       track(&tracker, imagesOf(rig, {test::still(place)}, SceneOptions(), 2000))) {
    if (s.time < 1002.0)
      continue;
    ASSERT_EQ(1u, s.leds.size());
    const TrackedLed& led = s.leds[0];
    EXPECT_EQ(TrackState::kTracked, led.state);
    EXPECT_EQ(4u, led.cameras.size());
    EXPECT_EQ(4u, led.rays_possible);
    EXPECT_LT((led.position - place).norm(), 6.0 * std::sqrt(led.position_covariance.trace()));
    squares += (led.position - place).squaredNorm();
    ++count;
  }
  std::vector<geometry::Observation> observations;
  for (const geometry::RigCamera& camera : rig.cameras)
    observations.push_back({&camera.camera, *camera.camera.project(place)});
  geometry::TriangulationOptions options;
  options.pixel_stddev = 0.3;
  const auto once = geometry::triangulate(observations, options);
  ASSERT_GT(count, 1000);
  EXPECT_LT(squares / count, once->covariance.trace());
}

TEST(Tracker, LateImagesGiveWhatTheyWouldHaveGivenInTime) {
  const std::vector<Path> leds = wanderers(4, 6);
  SceneOptions options;
  options.dropout = 0.1;
  options.ghosts = 0.5;
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, options, 1200);
  Tracker in_order(paperRig(), exact());
  track(&in_order, images);
  EXPECT_EQ(0u, in_order.counters().late);

  geometry::test::Random random(4);
  for (SceneImage& image : images)
    image.image.arrival += random.uniform(0.0, 0.1);
  std::stable_sort(images.begin(), images.end(),
                   [](auto& a, auto& b) { return a.image.arrival < b.image.arrival; });
  Tracker delayed(paperRig(), exact());
  const std::vector<Snapshot> snapshots = track(&delayed, images);
  EXPECT_GT(delayed.counters().late, 600u);
  EXPECT_EQ(0u, delayed.counters().dropped);
  EXPECT_EQ(0u, delayed.counters().disordered);
  expectSameLeds(stateAt(in_order, 1004.0), stateAt(delayed, 1004.0));
  // A late image makes no snapshot of its own; times only grow.
  EXPECT_LT(snapshots.size(), 600u);
  for (std::size_t i = 1; i < snapshots.size(); ++i)
    EXPECT_GT(snapshots[i].time, snapshots[i - 1].time);
}

TEST(Tracker, IdsLastWhileThePastIsRepeated) {
  const std::vector<Path> leds = wanderers(4, 7);
  SceneOptions options;
  options.delay_jitter = 0.01;
  Tracker tracker(paperRig(), exact());
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), leds, options, 2000))) {
    if (snapshot.time > options.start + 0.5) {
      EXPECT_EQ((std::set<std::uint32_t>{0, 1, 2, 3}), idsIn(snapshot, TrackState::kTracked));
    }
  }
  EXPECT_GT(tracker.counters().late, 500u);
}

TEST(Tracker, RepeatedAndOldImagesChangeNothing) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(4, 8), {}, 400);
  Tracker once(paperRig(), exact());
  track(&once, images);
  Tracker twice(paperRig(), exact());
  for (std::size_t i = 0; i < images.size(); ++i) {
    twice.add(images[i].camera, images[i].image);
    twice.add(images[i].camera, images[i].image);
    if (i >= 200)
      twice.add(images[i - 200].camera, images[i - 200].image);
  }
  EXPECT_EQ(400u, twice.counters().repeated);
  EXPECT_EQ(200u, twice.counters().dropped);
  expectSameLeds(stateAt(once, 1001.5), stateAt(twice, 1001.5));
}

TEST(Tracker, OfABurstThatSeemsToBeOfOneTimeTheLastImageCounts) {
  const std::vector<Path> leds = {test::circle({1.25, 1.25, 1.0}, 0.5, 3.0)};
  Tracker without(paperRig(), exact());
  Tracker with(paperRig(), exact());
  std::size_t compared = 0;
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 1600);
  for (std::size_t i = 0; i < images.size(); ++i) {
    CameraImage& image = images[i].image;
    // Twice a second all cameras' images are held up until there are three of each.
    const double since = std::fmod(image.stamp, 0.5);
    const int rank = since < 0.4 ? -1 : static_cast<int>((since - 0.4) / 0.01);
    if (rank >= 0 && rank < 3) {
      image.stamp += 0.01 * (2 - rank) + 1e-6 * rank;
      image.stamp_stddev = 0.001;
    }
    with.add(images[i].camera, image);
    if (rank != 0 && rank != 1)
      without.add(images[i].camera, image);
    if (rank < 3 || i < 200)
      continue;
    const double time = image.stamp + 0.1;
    const Snapshot state = stateAt(with, time);
    ASSERT_EQ((std::set<std::uint32_t>{0}), idsIn(state, TrackState::kPredicted)) << i;
    expectSameLeds(stateAt(without, time), state);
    ++compared;
  }
  EXPECT_GT(compared, 150u);
}

TEST(Tracker, ABagThatStartsOverIsTrackedAnew) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(2, 9), {}, 1200);
  Tracker tracker(paperRig(), exact());
  track(&tracker, images);
  const std::vector<Snapshot> again = track(&tracker, images);
  EXPECT_EQ(1u, tracker.counters().resets);
  EXPECT_EQ((std::set<std::uint32_t>{0, 1}), idsIn(again.front(), TrackState::kLost));
  std::size_t lost = 0;
  for (const Snapshot& snapshot : again)
    lost += idsIn(snapshot, TrackState::kLost).size();
  EXPECT_EQ(2u, lost);
  EXPECT_EQ((std::set<std::uint32_t>{2, 3}), idsIn(again.back(), TrackState::kTracked));
}

TEST(Tracker, ACameraThatLagsOrRunsAheadDoesNotHarmTheOthers) {
  const std::vector<Path> leds = wanderers(4, 10);
  for (const double offset : {-1.5, 2.5}) {
    std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 2000);
    for (SceneImage& image : images) {
      if (image.camera == 2) {
        image.image.stamp += offset;
        image.image.arrival += offset;  // its computer's clock is wrong
      }
    }
    Tracker tracker(paperRig(), exact());
    IdentityCheck check(leds);
    const std::vector<Snapshot> snapshots = track(&tracker, images);
    for (std::size_t i = 200; i < snapshots.size(); ++i)
      check.look(snapshots[i]);
    // At the start nobody knows yet whose clock is right.
    EXPECT_LE(tracker.counters().resets, 1u);
    EXPECT_GT(tracker.counters().dropped, 490u);
    EXPECT_EQ(0u, check.uncovered);
    EXPECT_GT(check.snapshots, 1250u);
  }
}

TEST(Tracker, ACameraWhoseClockIsPutBackDoesNotHarmTheOthers) {
  const std::vector<Path> leds = wanderers(4, 10);
  // From ahead to right, and from right to far behind and right again.
  for (const auto& [first, then] :
       std::vector<std::pair<double, double>>{{5.0, 0.0}, {0.0, -100.0}}) {
    std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 3000);
    for (std::size_t i = 0; i < images.size(); ++i) {
      const double offset = i < 1000 ? first : i < 2000 ? then : 0.0;
      if (images[i].camera == 2) {
        images[i].image.stamp += offset;
        images[i].image.arrival += offset;
      }
    }
    Tracker tracker(paperRig(), exact());
    IdentityCheck check(leds);
    const std::vector<Snapshot> snapshots = track(&tracker, images);
    for (std::size_t i = 200; i < snapshots.size(); ++i)
      check.look(snapshots[i]);
    EXPECT_LE(tracker.counters().resets, first > 0.0 ? 1u : 0u) << "at the start nobody knows";
    EXPECT_EQ(0u, check.uncovered);
    EXPECT_EQ(0u, check.switches);
    for (const TrackedLed& led : snapshots.back().leds)
      EXPECT_EQ(4u, led.cameras.size()) << "it is used again";
  }
}

TEST(Tracker, WhatIsHiddenIsPredictedAndFoundAgainUnderItsName) {
  const std::vector<Path> leds = {test::circle({1.25, 1.25, 1.0}, 0.4, 0.5)};
  SceneOptions options;
  options.hidden = [](std::size_t, std::size_t, double t) { return t > 1001.0 && t < 1001.25; };
  Tracker tracker(paperRig(), exact());
  bool predicted = false;
  for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), leds, options, 1000))) {
    if (s.time < 1000.5)
      continue;
    ASSERT_EQ(1u, s.leds.size());
    EXPECT_EQ(0u, s.leds[0].id);
    const bool is_predicted = s.leds[0].state == TrackState::kPredicted;
    predicted |= is_predicted;
    EXPECT_EQ(s.time > 1001.07 && s.time < 1001.24,
              is_predicted && s.time < 1001.24 && s.time > 1001.07);
    if (is_predicted && s.time > 1001.07) {
      EXPECT_TRUE(s.leds[0].cameras.empty());
      EXPECT_TRUE(std::isnan(s.leds[0].residual));
      EXPECT_LE(s.leds[0].last_observed, 1001.0);
    }
  }
  EXPECT_TRUE(predicted);
}

TEST(Tracker, WhatOneCameraSeesIsPredictedSinceItsDistanceIs) {
  const std::vector<Path> leds = {test::circle({1.25, 1.25, 1.0}, 0.4, 0.5)};
  SceneOptions options;
  options.hidden = [](std::size_t camera, std::size_t, double t) {
    return camera != 2 && t > 1001.0 && t < 1001.4;
  };
  const TrackerOptions tracker_options = exact();
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
      EXPECT_EQ(std::vector<std::size_t>{2}, led.cameras);
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

TEST(Tracker, WhatIsHiddenForLongIsLostOnceAndNewLater) {
  const std::vector<Path> leds = wanderers(2, 11);
  SceneOptions options;
  options.hidden = [](std::size_t, std::size_t led, double t) {
    return led == 1 && t > 1001.0 && t < 1003.0;
  };
  Tracker tracker(paperRig(), exact());
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

TEST(Tracker, TwoThatAreOneSpotInOneViewKeepTheirNames) {
  // They pass each other on the line of sight of the first camera, 0.3 m apart.
  const geometry::Rig rig = paperRig();
  const geometry::Camera& camera = rig.cameras[0].camera;
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  const Eigen::Vector3d along = (middle - camera.center()).normalized();
  const Eigen::Vector3d across = along.cross(Eigen::Vector3d::UnitZ()).normalized();
  const std::vector<Path> leds = {test::straight(middle - 0.15 * along, 0.3 * across, 1001.0),
                                  test::straight(middle + 0.15 * along, -0.3 * across, 1001.0)};
  SceneOptions options;
  options.merging_distance = 8.0;
  const std::vector<SceneImage> images = imagesOf(rig, leds, options, 800);
  EXPECT_TRUE(std::any_of(images.begin(), images.end(), [](const SceneImage& image) {
    return image.camera == 0 && image.leds_of_spot == std::vector<std::uint64_t>{3};
  }));
  Tracker tracker(rig, exact());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, images)) {
    if (snapshot.time > 1000.5)
      check.look(snapshot);
  }
  EXPECT_EQ(0u, check.switches);
  EXPECT_EQ(0u, check.renamed);
  EXPECT_EQ(0u, check.uncovered);
}

TEST(Tracker, TwoThatAreOneSpotInAllViewsAreToldApartByTheirMotion) {
  // They pass each other 1 cm apart, which no view resolves.
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  for (const double speed : {0.3, 0.6, 1.2}) {
    const Eigen::Vector3d velocity = speed * Eigen::Vector3d(0.6, 0.0, 0.8);
    const std::vector<Path> leds = {
        test::straight(middle, velocity, 1001.5),
        test::straight(middle + Eigen::Vector3d(0.0, 0.01, 0.0), -velocity, 1001.5)};
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
    Tracker tracker(paperRig(), exact());
    IdentityCheck check(leds);
    for (const Snapshot& snapshot : track(&tracker, images)) {
      if (snapshot.time > 1001.3)
        check.look(snapshot);
    }
    EXPECT_EQ(0u, check.switches) << speed;
    EXPECT_EQ(0u, check.renamed) << speed;
  }
}

// It blinks at the height of the cameras, where the first two that see it light up may face each
// other: their rays hardly tell how far along their line it is, its motion does.
TEST(Tracker, WhatBlinksKeepsItsMotionWhileItIsDark) {
  const Path led = test::circle({1.25, 1.25, 1.9}, 0.4, 0.5);
  SceneOptions options;
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 0.3) < 0.2; };
  const auto rmsWith = [&](double dark_time) {
    TrackerOptions tracker_options = exact();
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
  EXPECT_LT(rmsWith(0.3), 0.6 * rmsWith(0.0));
}

TEST(Tracker, WhatLeapsIsNeverTrackedWhereItIsNot) {
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
  Tracker tracker(paperRig(), exact());
  std::size_t in_time = 0;
  for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), {led}, options, 3900))) {
    const double since_leap = std::fmod(s.time - 1000.0, 0.25);
    bool covered = false;
    for (const TrackedLed& track : s.leds) {
      // Of the first images after a leap some may show what might as well be where it was.
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

TEST(Tracker, WhatIsThrownOffIsFoundAgainUnderItsName) {
  // A jerk that no way to move allows, and spots that are not the LED's.
  for (const double jump : {0.02, 0.04, 0.06}) {
    const Path led = [&](double t) {
      return Eigen::Vector3d(1.2 + (t > 1001.0 ? jump : 0.0), 1.3, 1.0);
    };
    Tracker tracker(paperRig(), exact());
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

TEST(Tracker, OfTwoThatShareAllSpotsForLongOneEnds) {
  // They meet; and then there is one light only.
  const std::vector<Path> leds = {test::still({1.25, 1.25, 1.0}), [](double t) {
                                    return Eigen::Vector3d(
                                        1.25, 1.25, 1.0 + std::max(0.004, 0.2 * (1001.0 - t)));
                                  }};
  SceneOptions options;
  options.merging_distance = 8.0;
  Tracker tracker(paperRig(), exact());
  const std::vector<Snapshot> snapshots =
      track(&tracker, imagesOf(paperRig(), leds, options, 2000));
  // No sooner than two that pass each other slowly may need.
  for (const Snapshot& s : snapshots) {
    if (s.time > 1000.2 && s.time < 1001.2) {
      EXPECT_EQ(2u, s.leds.size()) << s.time;
    }
  }
  EXPECT_EQ((std::set<std::uint32_t>{0}), idsIn(snapshots.back(), TrackState::kTracked));
  EXPECT_EQ(1u, snapshots.back().leds.size());
}

TEST(Tracker, LightsOfSingleCamerasAreNoLeds) {
  SceneOptions options;
  options.reflections = {{{100.0, 700.0}, {700.0, 60.0}}, {{900.0, 40.0}}, {}, {{60.0, 60.0}}};
  options.ghosts = 1.0;
  Tracker tracker(paperRig(), exact());
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), {}, options, 4000)))
    EXPECT_TRUE(idsIn(snapshot, TrackState::kTracked).empty()) << snapshot.time;
}

TEST(Tracker, WhatAFloorMirrorsCanBeKeptOut) {
  const std::vector<Path> leds = {test::still({1.25, 1.25, 0.3}), test::still({1.25, 1.25, -0.3})};
  const auto images = imagesOf(paperRig(), leds, {}, 400);
  Tracker open(paperRig(), exact());
  EXPECT_EQ(2u, track(&open, images).back().leds.size());
  TrackerOptions options = exact();
  options.minimum_corner = {-10.0, -10.0, 0.0};
  Tracker closed(paperRig(), options);
  const Snapshot last = track(&closed, images).back();
  ASSERT_EQ(1u, last.leds.size());
  EXPECT_GT(last.leds[0].position.z(), 0.0);
}

TEST(Tracker, MoreLightsThanACameraReports) {
  // The two nearest of three win in each view, so that each LED is seen by two of them or more.
  const std::vector<Path> leds = {test::still({0.6, 0.6, 0.9}), test::still({1.9, 0.7, 1.0}),
                                  test::still({1.3, 1.9, 1.1})};
  SceneOptions options;
  options.maximum_spots = 2;
  Tracker tracker(paperRig(), exact());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), leds, options, 1200))) {
    if (snapshot.time > 1000.5)
      check.look(snapshot);
  }
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_EQ(0u, check.renamed);
}

TEST(Tracker, ANewRigTakesOverTheTracks) {
  const std::vector<Path> leds = wanderers(3, 12);
  const geometry::Rig rig = paperRig();
  std::vector<SceneImage> images = imagesOf(rig, leds, {}, 1200);
  Tracker tracker(rig, exact());
  track(&tracker, {images.begin(), images.begin() + 600});
  tracker.setRig(rig);  // the same: nothing happens
  Tracker undisturbed(rig, exact());
  track(&undisturbed, {images.begin(), images.begin() + 600});
  expectSameLeds(stateAt(undisturbed, 1001.6), stateAt(tracker, 1001.6));

  geometry::Rig fewer = rig;
  fewer.cameras = {rig.cameras[3], rig.cameras[0], rig.cameras[1]};
  tracker.setRig(fewer);
  const std::array<std::size_t, 4> place = {1, 2, 9, 0};
  IdentityCheck check(leds);
  for (std::size_t i = 600; i < images.size(); ++i) {
    if (images[i].camera == 2)
      continue;
    tracker.add(place[images[i].camera], images[i].image);
    while (const Snapshot* snapshot = tracker.next()) {
      check.look(*snapshot);
      std::set<std::uint32_t> ids = idsIn(*snapshot, TrackState::kTracked);
      if (i < 604)  // not all cameras of the new rig had an image yet
        ids.merge(idsIn(*snapshot, TrackState::kPredicted));
      EXPECT_EQ((std::set<std::uint32_t>{0, 1, 2}), ids);
      EXPECT_EQ(3u, snapshot->views.size());
    }
  }
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_GT(check.snapshots, 400u);

  geometry::Rig broken = rig;
  broken.cameras[0].camera.intrinsics.fx = kNan;
  EXPECT_THROW(tracker.setRig(broken), geometry::Error);
}

TEST(Tracker, NonsenseNeverReachesAState) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(3, 13), {}, 600);
  Tracker clean(paperRig(), exact());
  track(&clean, images);
  Tracker tracker(paperRig(), exact());
  int nonsense = 0;
  for (const SceneImage& image : images) {
    CameraImage bad = image.image;
    bad.maximum_spots = 99;
    for (const double x : {kNan, kInfinity, -kInfinity, 1e9, -300.0}) {
      Spot spot;
      spot.pixel = {x, 300.0};
      bad.spots.insert(bad.spots.begin(), spot);
      spot.pixel = {300.0, x};
      bad.spots.push_back(spot);
    }
    for (const double x : {kNan, kInfinity}) {
      CameraImage impossible = bad;
      impossible.stamp = x;
      tracker.add(image.camera, impossible);
      impossible = bad;
      impossible.arrival = x;
      tracker.add(image.camera, impossible);
      nonsense += 2;
    }
    bad.stamp_stddev = kNan;  // the option's holds
    tracker.add(image.camera, bad);
  }
  EXPECT_EQ(static_cast<std::uint64_t>(nonsense), tracker.counters().dropped);
  expectSameLeds(stateAt(clean, 1002.0), stateAt(tracker, 1002.0));
}

TEST(Tracker, TimeOffsetsOfTheRig) {
  const std::vector<Path> leds = wanderers(2, 14);
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 800);
  Tracker plain(paperRig(), exact());
  track(&plain, images);
  geometry::Rig rig = paperRig();
  rig.cameras[1].time_offset = 0.25;
  rig.cameras[1].time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  rig.cameras[1].time_offset_epoch = 7;
  for (SceneImage& image : images) {
    if (image.camera == 1 && image.image.stamp < 1001.0) {
      image.image.stamp -= 0.25;
      image.image.clock_epoch = 7;  // later images are of another epoch, and right as they are
    }
  }
  Tracker tracker(rig, exact());
  track(&tracker, images);
  const Snapshot a = stateAt(plain, 1002.0);
  const Snapshot b = stateAt(tracker, 1002.0);
  ASSERT_EQ(a.leds.size(), b.leds.size());
  for (std::size_t i = 0; i < a.leds.size(); ++i)
    EXPECT_LT((a.leds[i].position - b.leds[i].position).norm(), 1e-6);  // stamps are rounded
}

TEST(Tracker, MaskedLightIsShownAndNotUsed) {
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  geometry::Rig rig = paperRig();
  rig.cameras[0].masks.push_back({*rig.cameras[0].camera.project(place), 30.0});
  Tracker tracker(rig, exact());
  const Snapshot last =
      track(&tracker, imagesOf(rig, {test::still(place)}, SceneOptions(), 400)).back();
  ASSERT_EQ(1u, last.leds.size());
  EXPECT_EQ((std::vector<std::size_t>{1, 2, 3}), last.leds[0].cameras);
  EXPECT_EQ(3u, last.leds[0].rays_possible);
  ASSERT_EQ(1u, last.views[0].spots.size());
  EXPECT_EQ(SpotUse::kMasked, last.views[0].spots[0].use);
  EXPECT_EQ(SpotUse::kAssigned, last.views[1].spots[0].use);
  EXPECT_EQ(last.leds[0].id, last.views[1].spots[0].led);
}

TEST(Tracker, RoomsDoNotKnowOfEachOther) {
  const geometry::Rig rig = test::roomsRig(2, 3);
  geometry::test::Random random(15);
  const std::vector<Path> leds = {test::wandering(random, {0.3, 0.0, 1.0}, 0.3, 1.0),
                                  test::wandering(random, {100.0, 0.3, 1.0}, 0.3, 1.0)};
  const std::vector<SceneImage> images = imagesOf(rig, leds, {}, 1200);
  std::vector<SceneImage> first_room;
  std::copy_if(images.begin(), images.end(), std::back_inserter(first_room),
               [](const SceneImage& image) { return image.camera < 3; });
  Tracker both(rig, exact());
  track(&both, images);
  Tracker first(rig, exact());
  track(&first, first_room);
  const Snapshot a = stateAt(both, 1003.0);
  const Snapshot b = stateAt(first, 1003.0);
  ASSERT_EQ(2u, a.leds.size());
  ASSERT_EQ(1u, b.leds.size());
  const bool first_is_0 = a.leds[0].position.x() < 50.0;
  EXPECT_EQ(a.leds[first_is_0 ? 0 : 1].position, b.leds[0].position);
}

TEST(Tracker, TheCalibrationsUncertaintyIsInTheCovariance) {
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  const auto images = imagesOf(paperRig(), {test::still(place)}, SceneOptions(), 800);
  Tracker exactly(paperRig(), exact());
  const TrackedLed known = track(&exactly, images).back().leds.at(0);
  geometry::Rig rig = paperRig();
  rig.covariance = 1e-6 * Eigen::MatrixXd::Identity(64, 64);
  geometry::CalibrationUncertainty uncertainty(rig);
  const auto share =
      uncertainty.covarianceNear(known.position, known.cameras.data(), known.cameras.size());
  ASSERT_TRUE(share);
  EXPECT_GT(share->trace(), 0.0);
  Tracker uncertain(rig, exact());
  const TrackedLed led = track(&uncertain, images).back().leds.at(0);
  EXPECT_EQ(known.position, led.position);
  EXPECT_LT((led.position_covariance - known.position_covariance - *share).norm(),
            1e-9 * share->norm());
  EXPECT_EQ(known.velocity_covariance, led.velocity_covariance);
}

TEST(Tracker, OutputAtAnyTime) {
  Tracker tracker(paperRig(), exact());
  Snapshot snapshot;
  EXPECT_FALSE(tracker.predictTo(1000.0, &snapshot));
  const std::vector<Path> leds = {test::straight({1.0, 1.0, 1.0}, {0.5, 0.0, 0.0}, 1000.0)};
  const std::vector<Snapshot> snapshots = track(&tracker, imagesOf(paperRig(), leds, {}, 400));
  const double last = snapshots.back().time;
  EXPECT_FALSE(tracker.predictTo(last - 0.001, &snapshot));
  ASSERT_TRUE(tracker.predictTo(last + 0.01, &snapshot));
  EXPECT_EQ(last + 0.01, snapshot.time);
  ASSERT_EQ(1u, snapshot.leds.size());
  const Eigen::Vector3d error = snapshot.leds[0].position - leds[0](last + 0.01);
  EXPECT_LT(error.norm(), 6.0 * std::sqrt(snapshot.leds[0].position_covariance.trace()));
  EXPECT_GT(snapshot.leds[0].position_covariance.trace(),
            snapshots.back().leds[0].position_covariance.trace());

  TrackerOptions options = exact();
  options.output_interval = 0.02;
  Tracker seldom(paperRig(), options);
  const std::vector<Snapshot> few = track(&seldom, imagesOf(paperRig(), leds, {}, 400));
  for (std::size_t i = 1; i < few.size(); ++i)
    EXPECT_GE(few[i].time, few[i - 1].time + 0.02);
  EXPECT_GT(few.size(), 40u);
}

TEST(Tracker, TheFactoryMakesBothKinds) {
  EstimatorOptions options;
  EXPECT_TRUE(dynamic_cast<Tracker*>(makeEstimator(paperRig(), options).get()));
  options.mode = Mode::kInstant;
  EXPECT_TRUE(dynamic_cast<fusion::InstantFuser*>(makeEstimator(paperRig(), options).get()));
  EXPECT_THROW(makeEstimator(geometry::Rig(), options), geometry::Error);
}

}  // namespace
}  // namespace wiimote_tracker::tracking
