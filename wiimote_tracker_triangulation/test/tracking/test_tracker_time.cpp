// Late, repeated and mistimed images, and wrong clocks.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Tracker, LateImagesGiveTheSameResultAsInTime) {
  const std::vector<Path> leds = wanderers(4, 6);
  SceneOptions options;
  options.dropout = 0.1;
  options.ghosts = 0.5;
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, options, 1200);
  Tracker in_order(paperRig(), exactOptions());
  track(&in_order, images);
  EXPECT_EQ(0u, in_order.counters().late);

  geometry::test::Random random(4);
  for (SceneImage& image : images)
    image.image.arrival += random.uniform(0.0, 0.1);
  std::stable_sort(images.begin(), images.end(),
                   [](auto& a, auto& b) { return a.image.arrival < b.image.arrival; });
  Tracker delayed(paperRig(), exactOptions());
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

TEST(Tracker, IdsStayTheSameAfterARollBack) {
  const std::vector<Path> leds = wanderers(4, 7);
  SceneOptions options;
  options.delay_jitter = 0.01;
  Tracker tracker(paperRig(), exactOptions());
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), leds, options, 2000))) {
    if (snapshot.time > options.start + 0.5) {
      EXPECT_EQ((std::set<std::uint32_t>{0, 1, 2, 3}), idsIn(snapshot, TrackState::kTracked));
    }
  }
  EXPECT_GT(tracker.counters().late, 500u);
}

TEST(Tracker, RepeatedAndOldImagesChangeNothing) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(4, 8), {}, 400);
  Tracker once(paperRig(), exactOptions());
  track(&once, images);
  Tracker twice(paperRig(), exactOptions());
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

TEST(Tracker, OnlyTheLastImageOfABurstOfOneStampCounts) {
  const std::vector<Path> leds = {circle({1.25, 1.25, 1.0}, 0.5, 3.0)};
  Tracker without(paperRig(), exactOptions());
  Tracker with(paperRig(), exactOptions());
  std::size_t compared = 0;
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 1600);
  for (std::size_t i = 0; i < images.size(); ++i) {
    CameraImage& image = images[i].image;
    // Twice a second all cameras' images are held up until there are three of
    // each.
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

/// Its images arrive with the others', so that its clock seems right.
TEST(Tracker, ACameraWhoseImagesAreAlwaysTooOldIsNamed) {
  std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(2, 10), {}, 600);
  Tracker tracker(paperRig(), exactOptions());
  for (SceneImage& image : images) {
    image.image.stamp -= image.camera == 3 ? 0.5 : 0.0;
    tracker.add(image.camera, image.image);
  }
  const auto fault = tracker.cameraFault(3);
  ASSERT_TRUE(fault);
  EXPECT_EQ(CameraFault::Kind::kLate, fault->kind);
  EXPECT_NEAR(-0.5, fault->clock_ahead, 0.02);
  EXPECT_FALSE(tracker.cameraFault(0));
}

/// The network of a computer with two of four cameras is cut for 3 s.
TEST(Tracker, GoesOnWhenManyImagesThatWaitedComeTogether) {
  std::vector<SceneImage> images =
      imagesOf(paperRig(), {circle({1.25, 1.25, 1.0}, 0.5, 1.5)}, {}, 3200);
  for (SceneImage& image : images) {
    const double arrival = image.image.arrival;
    const bool waits = image.camera >= 2 && arrival > 1002.005 && arrival < 1005.005;
    // Of delivery: all of camera 2, then all of camera 3.
    image.true_time = waits ? 1005.005 + 1e-6 * static_cast<double>(image.camera) : arrival;
  }
  std::stable_sort(images.begin(), images.end(),
                   [](auto& a, auto& b) { return a.true_time < b.true_time; });
  Tracker tracker(paperRig(), exactOptions());
  const std::vector<Snapshot> snapshots = track(&tracker, images);
  EXPECT_EQ(0u, tracker.counters().resets);
  EXPECT_EQ((std::set<std::uint32_t>{0}), idsIn(snapshots.back(), TrackState::kTracked));
}

/// The others' last images are too old by then to show that its clock is ahead.
TEST(Tracker, AGapOfACameraAfterHalfOfThemEndedCostsOnlyTheGap) {
  const std::vector<SceneImage> images =
      imagesOf(paperRig(), {circle({1.25, 1.25, 1.0}, 0.5, 1.5)}, {}, 1600);
  Tracker tracker(paperRig(), exactOptions());
  for (const SceneImage& image : images) {
    const double arrival = image.image.arrival;
    const bool is_lost = image.camera >= 2
                             ? arrival > 1002.0
                             : image.camera == 0 && arrival > 1002.2 && arrival < 1002.26;
    if (!is_lost)
      tracker.add(image.camera, image.image);
  }
  EXPECT_EQ(0u, tracker.counters().dropped);
}

/// Half of the cameras run alone with a clock that is an hour ahead, and end; then the others
/// start. Or these ran before, too: their images look like a backlog for longer.
TEST(Tracker, GoesOnAfterCamerasWhoseClockWasAheadEnded) {
  for (const bool ran_before : {false, true}) {
    std::vector<SceneImage> images;
    for (SceneImage& image :
         imagesOf(paperRig(), {circle({1.25, 1.25, 1.0}, 0.5, 1.5)}, {}, 18000)) {
      const double time = image.image.arrival;
      const bool is_ahead = image.camera < 2;
      const bool runs = is_ahead ? time > 1001.0 && time < 1003.0
                                 : time > 1003.0 || (ran_before && time < 1001.0);
      if (!runs)
        continue;
      image.image.arrival += is_ahead ? 3600.0 : 0.0;
      images.push_back(image);
    }
    Tracker tracker(paperRig(), exactOptions());
    const std::vector<Snapshot> snapshots = track(&tracker, images);
    EXPECT_EQ(1u, tracker.counters().resets) << ran_before;
    EXPECT_EQ(1u, idsIn(snapshots.back(), TrackState::kTracked).size()) << ran_before;
    EXPECT_NEAR(images.back().image.arrival, snapshots.back().time, 0.1) << ran_before;
  }
}

TEST(Tracker, RestartsWhenABagStartsOver) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(2, 9), {}, 1200);
  Tracker tracker(paperRig(), exactOptions());
  track(&tracker, images);
  const std::vector<Snapshot> again = track(&tracker, images);
  EXPECT_EQ(1u, tracker.counters().resets);
  EXPECT_EQ((std::set<std::uint32_t>{0, 1}), idsIn(again.front(), TrackState::kLost));
  std::size_t lost = 0;
  for (const Snapshot& snapshot : again) {
    lost += idsIn(snapshot, TrackState::kLost).size();
    for (const CameraView& view : snapshot.views)
      EXPECT_LE(view.time.value_or(0.0), snapshot.time) << "no view is of the former time";
  }
  EXPECT_EQ(2u, lost);
  EXPECT_EQ((std::set<std::uint32_t>{2, 3}), idsIn(again.back(), TrackState::kTracked));
}

/// As when another bag is played, whose rig was calibrated anew.
TEST(Tracker, RestartsWhenANewRigComesWithAnEarlierTime) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(2, 9), {}, 1200);
  Tracker tracker(paperRig(), exactOptions());
  track(&tracker, images);
  geometry::Rig rig = paperRig();
  rig.cameras[0].camera.identity = "00:00:00:00:00:01";  // so that its id is another
  tracker.setRig(rig);
  const std::vector<Snapshot> again = track(&tracker, images);
  EXPECT_EQ(1u, tracker.counters().resets);
  ASSERT_GT(again.size(), 1150u);
  EXPECT_EQ((std::set<std::uint32_t>{0, 1}), idsIn(again.front(), TrackState::kLost));
  EXPECT_EQ(2u, idsIn(again.back(), TrackState::kTracked).size());
}

TEST(Tracker, AStepBackOfAllClocksNeverLeavesAnLedAtItsOldPlace) {
  const Path led = circle({1.25, 1.25, 1.0}, 0.5, 1.5);
  for (const double step : {0.3, 1.0}) {  // 1 s: a leap second
    std::vector<SceneImage> images = imagesOf(paperRig(), {led}, {}, 1600);
    Tracker tracker(paperRig(), exactOptions());
    std::size_t tracked = 0;
    for (SceneImage& image : images) {
      if (image.true_time > 1002.0) {
        image.image.stamp -= step;
        image.image.arrival -= step;
        ++image.image.clock_epoch;
      }
      tracker.add(image.camera, image.image);
      while (const Snapshot* snapshot = tracker.next()) {
        const Eigen::Vector3d truth = led(image.true_time);
        for (const TrackedLed& each : snapshot->leds) {
          if (each.state != TrackState::kTracked)
            continue;
          EXPECT_LT((each.position - truth).norm(), 0.1) << image.true_time;
          ++tracked;
        }
      }
    }
    EXPECT_EQ(1u, tracker.counters().resets);
    EXPECT_GT(tracked, 1450u);
  }
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
    Tracker tracker(paperRig(), exactOptions());
    IdentityCheck check(leds);
    const std::vector<Snapshot> snapshots = track(&tracker, images);
    for (std::size_t i = 200; i < snapshots.size(); ++i)
      check.add(snapshots[i]);
    // At the start it is unknown whose clock is right.
    EXPECT_LE(tracker.counters().resets, 1u);
    EXPECT_GT(tracker.counters().dropped, 490u);
    EXPECT_EQ(0u, check.uncovered);
    EXPECT_GT(check.snapshots, 1250u);
  }
}

TEST(Tracker, ACameraWhoseClockIsSetBackDoesNotHarmTheOthers) {
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
    Tracker tracker(paperRig(), exactOptions());
    IdentityCheck check(leds);
    const std::vector<Snapshot> snapshots = track(&tracker, images);
    for (std::size_t i = 200; i < snapshots.size(); ++i)
      check.add(snapshots[i]);
    EXPECT_LE(tracker.counters().resets, first > 0.0 ? 1u : 0u)
        << "at the start it is unknown whose clock is right";
    EXPECT_EQ(0u, check.uncovered);
    EXPECT_EQ(0u, check.switches);
    EXPECT_GT(check.snapshots, 2000u);
    ASSERT_EQ(4u, snapshots.back().leds.size());
    for (const TrackedLed& led : snapshots.back().leds)
      EXPECT_EQ(4u, led.cameras.size()) << "it is used again";
  }
}

TEST(Tracker, InvalidInputNeverReachesAState) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(3, 13), {}, 600);
  Tracker clean(paperRig(), exactOptions());
  track(&clean, images);
  Tracker tracker(paperRig(), exactOptions());
  int nonsense = 0;
  for (const SceneImage& image : images) {
    CameraImage bad = image.image;
    bad.maximum_spots = 99;
    for (const double x : {kNotANumber, kInfinity, -kInfinity, 1e9, -300.0}) {
      Spot spot;
      spot.pixel = {x, 300.0};
      bad.spots.insert(bad.spots.begin(), spot);
      spot.pixel = {300.0, x};
      bad.spots.push_back(spot);
    }
    for (const double x : {kNotANumber, kInfinity}) {
      CameraImage impossible = bad;
      impossible.stamp = x;
      tracker.add(image.camera, impossible);
      impossible = bad;
      impossible.arrival = x;
      tracker.add(image.camera, impossible);
      nonsense += 2;
    }
    bad.stamp_stddev = kNotANumber;  // the option's holds
    tracker.add(image.camera, bad);
  }
  EXPECT_EQ(static_cast<std::uint64_t>(nonsense), tracker.counters().dropped);
  expectSameLeds(stateAt(clean, 1002.0), stateAt(tracker, 1002.0));
}

TEST(Tracker, AppliesTheTimeOffsetsOfTheRig) {
  const std::vector<Path> leds = wanderers(2, 14);
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 800);
  geometry::Rig rig = paperRig();
  rig.cameras[1].time_offset = 0.0;
  rig.cameras[1].time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  rig.cameras[1].time_offset_epoch = 7;
  for (SceneImage& image : images)  // later images are of another epoch
    image.image.clock_epoch = image.camera == 1 && image.image.stamp < 1001.0 ? 7 : 8;
  Tracker plain(rig, exactOptions());
  track(&plain, images);
  rig.cameras[1].time_offset = 0.25;
  for (SceneImage& image : images) {
    image.image.stamp -= image.image.clock_epoch == 7 ? 0.25 : 0.0;
    image.image.arrival -= image.image.clock_epoch == 7 ? 0.25 : 0.0;
  }
  Tracker tracker(rig, exactOptions());
  track(&tracker, images);
  const Snapshot a = stateAt(plain, 1002.0);
  const Snapshot b = stateAt(tracker, 1002.0);
  ASSERT_FALSE(a.leds.empty());
  ASSERT_EQ(a.leds.size(), b.leds.size());
  for (std::size_t i = 0; i < a.leds.size(); ++i)
    EXPECT_LT((a.leds[i].position - b.leds[i].position).norm(),
              1e-6);  // stamps are rounded
}

TEST(Tracker, PredictsToAnyLaterTime) {
  Tracker tracker(paperRig(), exactOptions());
  Snapshot snapshot;
  EXPECT_FALSE(tracker.predictTo(1000.0, &snapshot));
  const std::vector<Path> leds = {straight({1.0, 1.0, 1.0}, {0.5, 0.0, 0.0}, 1000.0)};
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
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
