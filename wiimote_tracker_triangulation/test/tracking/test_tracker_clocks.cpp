// Cameras whose clocks, or the stamps of some images, are wrong do not harm the others.
#include "tracking/tracker_runs.h"
#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

/// What a clock adds to the time of an image [s]; nothing: the image never comes.
using Clock = std::function<std::optional<double>(std::size_t camera, std::size_t number)>;

struct Rows {
  std::size_t tracked = 0;  // LEDs in snapshots
  std::size_t wrong = 0;    // of these, not near an LED
  double rms = 0.0;         // [m]
  std::uint64_t resets = 0;
  std::optional<CameraFault> fault;  // of camera 2
};

/// Tracks four LEDs for 10 s; what the first second gives is not counted.
Rows rowsWith(const geometry::Rig& rig, double speed, const Clock& clock) {
  const Eigen::Vector3d middle =
      rig.cameras.size() == 4 ? Eigen::Vector3d(1.25, 1.25, 1.0) : Eigen::Vector3d(0.0, 0.0, 1.0);
  geometry::test::Random random(10);
  std::vector<Path> leds;
  for (const double x : {-0.45, 0.45}) {
    for (const double y : {-0.45, 0.45})
      leds.push_back(wandering(random, middle + Eigen::Vector3d(x, y, 0.0), 0.25, speed));
  }
  SceneOptions options;
  options.delay_jitter = 0.002;
  Scene scene(rig, leds, options, 1);
  Tracker tracker(rig, exactOptions());
  IdentityCheck check(leds);
  Rows rows;
  std::vector<std::size_t> numbers(rig.cameras.size());
  for (std::size_t i = 0; i < 1000 * rig.cameras.size(); ++i) {
    SceneImage image = scene.next();
    const std::optional<double> ahead = clock(image.camera, numbers[image.camera]++);
    if (!ahead)
      continue;
    image.image.stamp += *ahead;
    image.image.arrival += *ahead;
    tracker.add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker.next()) {
      if (snapshot->time < options.start + 1.0)
        continue;
      rows.tracked += idsIn(*snapshot, TrackState::kTracked).size();
      check.add(*snapshot);
    }
  }
  rows.wrong = check.false_tracks;
  rows.rms = check.rms();
  rows.resets = tracker.counters().resets;
  rows.fault = tracker.cameraFault(2);
  return rows;
}

std::optional<double> isRight(std::size_t, std::size_t) {
  return 0.0;
}

void expectAsGoodAs(const Rows& without, const Rows& with, const std::string& what) {
  EXPECT_GE(with.tracked, 0.98 * without.tracked) << what;
  EXPECT_EQ(without.wrong, with.wrong) << what;
  EXPECT_LE(with.rms, 1.1 * without.rms) << what;
}

TEST(TrackerClocks, OneCameraAheadOrBehindDoesNotHarmTheOthers) {
  const Rows without = rowsWith(paperRig(), 1.0, [](std::size_t camera, std::size_t) {
    return camera == 2 ? std::nullopt : std::optional<double>(0.0);
  });
  ASSERT_GT(without.tracked, 8500u);
  for (const double ahead : {-10.0, -0.5, -0.1, 0.06, 0.1, 0.3, 0.5, 1.0, 5.0}) {
    const Rows with = rowsWith(paperRig(), 1.0,
                               [ahead](std::size_t camera, std::size_t) -> std::optional<double> {
                                 return camera == 2 ? ahead : 0.0;
                               });
    expectAsGoodAs(without, with, std::to_string(ahead) + " s ahead");
  }
}

TEST(TrackerClocks, ASmallErrorIsRecognisedByTheMotionAndCorrected) {
  const Rows right = rowsWith(paperRig(), 1.0, isRight);
  for (const double ahead : {-0.03, 0.01, 0.02, 0.03, 0.04}) {
    const Rows with = rowsWith(paperRig(), 1.0,
                               [ahead](std::size_t camera, std::size_t) -> std::optional<double> {
                                 return camera == 2 ? ahead : 0.0;
                               });
    EXPECT_GE(with.tracked, 0.97 * right.tracked) << ahead;  // 0.79 without the camera
    EXPECT_EQ(0u, with.wrong) << ahead;
    EXPECT_LE(with.rms, 1.1 * right.rms) << ahead;
    ASSERT_TRUE(with.fault) << ahead;
    EXPECT_EQ(CameraFault::Kind::kCorrectedClock, with.fault->kind);
    EXPECT_NEAR(ahead, with.fault->clock_ahead, 0.004);
  }
}

/// The rig's cameras may be turned about their axes [rad, standard deviation].
geometry::Rig withTurns(geometry::Rig rig, double stddev) {
  const auto count = static_cast<Eigen::Index>(rig.cameras.size());
  rig.covariance =
      Eigen::MatrixXd::Zero(geometry::kParameters * count, geometry::kParameters * count);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto& pose = rig.cameras[i].camera.world_from_camera;
    const Eigen::Index turn = geometry::firstParameter(i) + geometry::kRotation;
    const Eigen::Vector3d axis = pose.linear().col(2);
    rig.covariance.block<3, 3>(turn, turn) = stddev * stddev * axis * axis.transpose();
  }
  return rig;
}

TEST(TrackerClocks, ATurnedCameraThatAnLedCirclesBeforeHasNoWrongClock) {
  constexpr double kTurn = 0.01;  // [rad], 10 ms of a circle of 0.5 m at 0.5 m/s
  const geometry::Rig truth = paperRig();
  for (const double turn : {-kTurn, kTurn}) {
    geometry::Rig rig = withTurns(truth, kTurn);
    rig.cameras[2].camera.world_from_camera.linear() *=
        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (const double speed : {-0.5, 0.3, 0.5}) {
      Tracker tracker(rig, exactOptions());
      const std::vector<Path> leds = {circle({1.25, 1.25, 1.0}, 0.5, speed)};
      bool is_faulty = false;
      const std::vector<SceneImage> images = imagesOf(truth, leds, {}, 48000);
      for (const SceneImage& image : images) {
        tracker.add(image.camera, image.image);
        for (std::size_t camera = 0; camera < truth.cameras.size(); ++camera)
          is_faulty = is_faulty || tracker.cameraFault(camera);
      }
      EXPECT_FALSE(is_faulty) << turn << " rad, " << speed << " m/s";
      const Snapshot last = stateAt(tracker, images.back().image.stamp + 0.01);
      EXPECT_EQ(1u, idsIn(last, TrackState::kTracked).size());
    }
  }
}

TEST(TrackerClocks, AWrongClockOfACoarseRigIsRecognised) {
  for (const double ahead : {-0.03, 0.02}) {
    const Rows rows = rowsWith(withTurns(paperRig(), 0.01), 1.0,
                               [ahead](std::size_t camera, std::size_t) -> std::optional<double> {
                                 return camera == 2 ? ahead : 0.0;
                               });
    ASSERT_TRUE(rows.fault) << ahead;
    EXPECT_EQ(CameraFault::Kind::kCorrectedClock, rows.fault->kind);
    EXPECT_NEAR(ahead, rows.fault->clock_ahead, 0.004);
  }
}

TEST(TrackerClocks, AClockThatDriftsIsFollowed) {
  const Rows right = rowsWith(paperRig(), 1.0, isRight);
  const Rows with = rowsWith(
      paperRig(), 1.0, [](std::size_t camera, std::size_t number) -> std::optional<double> {
        return camera == 2 ? 5e-6 * static_cast<double>(number) : 0.0;  // 500 ppm
      });
  expectAsGoodAs(right, with, "drift");
  ASSERT_TRUE(with.fault);
  EXPECT_EQ(CameraFault::Kind::kCorrectedClock, with.fault->kind);
  EXPECT_NEAR(0.005, with.fault->clock_ahead, 0.001);
}

TEST(TrackerClocks, AClockThatIsSetDoesNotHarmTheOthers) {
  const Rows without = rowsWith(paperRig(), 1.0, isRight);
  for (const double ahead : {-0.3, 0.1, 0.5}) {
    const Rows with = rowsWith(
        paperRig(), 1.0, [ahead](std::size_t camera, std::size_t number) -> std::optional<double> {
          return camera == 2 && number > 300 && number < 700 ? ahead : 0.0;
        });
    EXPECT_EQ(0u, with.resets);
    EXPECT_GE(with.tracked, 0.98 * 0.9 * without.tracked)
        << "there are fewer snapshots without the camera's images";
    EXPECT_EQ(0u, with.wrong);
    EXPECT_LE(with.rms, 1.2 * without.rms);
  }
}

TEST(TrackerClocks, SingleImagesAheadAreLeftOut) {
  const Rows without = rowsWith(paperRig(), 1.0, isRight);
  for (const std::size_t every : {25u, 10000u}) {
    const Rows with = rowsWith(
        paperRig(), 1.0, [every](std::size_t camera, std::size_t number) -> std::optional<double> {
          return camera == 1 && number % every == 500 % every && number >= 500 ? 0.3 : 0.0;
        });
    expectAsGoodAs(without, with, "every " + std::to_string(every));
  }
}

TEST(TrackerClocks, TheLargerGroupThatAgreesCounts) {
  const geometry::Rig rig = roomsRig(1, 5);
  const Rows without = rowsWith(rig, 1.0, [](std::size_t camera, std::size_t) {
    return camera < 2 ? std::nullopt : std::optional<double>(0.0);
  });
  ASSERT_GT(without.tracked, 8000u);
  for (const double ahead : {-0.5, 0.5}) {
    const Rows with =
        rowsWith(rig, 1.0, [ahead](std::size_t camera, std::size_t) -> std::optional<double> {
          return camera < 2 ? ahead : 0.0;
        });
    expectAsGoodAs(without, with, std::to_string(ahead) + " s ahead");
  }
}

TEST(TrackerClocks, NoGroupCountsIfTwoAreEquallyLarge) {
  const Rows rows =
      rowsWith(paperRig(), 1.0, [](std::size_t camera, std::size_t) -> std::optional<double> {
        return camera < 2 ? 0.5 : 0.0;
      });
  EXPECT_EQ(0u, rows.tracked);
}

TEST(TrackerClocks, AWrongClockIsMeasured) {
  std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(2, 10), {}, 400);
  Tracker tracker(paperRig(), exactOptions());
  for (SceneImage& image : images) {
    image.image.stamp += image.camera == 3 ? 0.5 : 0.0;
    image.image.arrival += image.camera == 3 ? 0.5 : 0.0;
    tracker.add(image.camera, image.image);
  }
  const auto fault = tracker.cameraFault(3);
  ASSERT_TRUE(fault);
  EXPECT_EQ(CameraFault::Kind::kWrongClock, fault->kind);
  EXPECT_NEAR(0.5, fault->clock_ahead, 0.02);
  EXPECT_FALSE(tracker.cameraFault(0));
}

TEST(TrackerClocks, DelayedImagesAreNoWrongClocks) {
  // One computer's network is stopped for 0.2 s of each second: its two cameras' images come late.
  std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(4, 6), {}, 4000);
  for (SceneImage& image : images) {
    const double since = std::fmod(image.image.arrival, 1.0);
    if (image.camera < 2 && since > 0.5 && since < 0.7)
      image.true_time = image.image.arrival + 0.7 - since;  // of delivery
    else
      image.true_time = image.image.arrival;
  }
  std::stable_sort(images.begin(), images.end(),
                   [](auto& a, auto& b) { return a.true_time < b.true_time; });
  Tracker tracker(paperRig(), exactOptions());
  for (const SceneImage& image : images) {
    tracker.add(image.camera, image.image);
    while (tracker.next()) {
    }
    for (std::size_t camera = 0; camera < 4; ++camera)
      ASSERT_FALSE(tracker.cameraFault(camera)) << camera << " at " << image.true_time;
  }
  EXPECT_EQ(0u, tracker.counters().resets);
  EXPECT_LT(tracker.counters().dropped, 80u);  // those older than the history
}

TEST(TrackerClocks, OnlyTheCameraWithASlowNetworkIsNamed) {
  for (const std::size_t cameras : {3u, 4u, 5u}) {
    const geometry::Rig rig = roomsRig(1, static_cast<int>(cameras));
    SceneOptions options;
    options.delay_jitter = 0.002;
    std::vector<SceneImage> images = imagesOf(rig, {circle({0.0, 0.0, 1.0}, 0.5, 1.0)}, options,
                                              800 * static_cast<int>(cameras));
    for (SceneImage& image : images) {
      const double arrival = image.image.arrival;
      const bool is_slow = image.camera == 0 && arrival > 1002.0 && arrival < 1005.0;
      image.true_time = arrival + (is_slow ? 0.2 : 0.0);  // of delivery
    }
    std::stable_sort(images.begin(), images.end(),
                     [](auto& a, auto& b) { return a.true_time < b.true_time; });
    Tracker tracker(rig, exactOptions());
    bool was_named = false;
    for (const SceneImage& image : images) {
      tracker.add(image.camera, image.image);
      was_named |= tracker.cameraFault(0).has_value();
      for (std::size_t camera = 1; camera < cameras; ++camera)
        ASSERT_FALSE(tracker.cameraFault(camera))
            << "camera " << camera << " of " << cameras << " at " << image.true_time;
    }
    EXPECT_TRUE(was_named);
    EXPECT_FALSE(tracker.cameraFault(0));
  }
}

/// Two of four cameras' clocks are wrong for 4 s, and their processes pause now and then: images
/// that waited come all at once.
IdentityCheck withWrongClocksAndPauses(const std::vector<Path>& leds, double ahead, double pause) {
  std::vector<SceneImage> images = imagesOf(paperRig(), leds, {}, 4000);
  for (SceneImage& image : images) {
    const double arrival = image.image.arrival;
    const double since = std::fmod(arrival, 1.3);
    const bool waits = image.camera >= 2 && since < pause;
    image.true_time = arrival + (waits ? pause - since : 0.0);  // of delivery
    const bool wrong = image.camera >= 2 && arrival > 1003.2 && arrival < 1007.4;
    image.image.stamp += wrong ? ahead : 0.0;
    image.image.arrival += wrong ? ahead : 0.0;
  }
  std::stable_sort(images.begin(), images.end(),
                   [](auto& a, auto& b) { return a.true_time < b.true_time; });
  Tracker tracker(paperRig(), exactOptions());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, images))
    check.add(snapshot);
  return check;
}

TEST(TrackerClocks, PausesDoNotMakeWrongClocksLookRight) {
  for (const double ahead : {-0.5, 0.5}) {
    for (const double pause : {0.47, 0.8}) {
      const IdentityCheck check = withWrongClocksAndPauses(wanderers(3, 6), ahead, pause);
      EXPECT_EQ(0u, check.false_tracks) << ahead << ", " << pause;
      EXPECT_GT(check.near, 4000u) << ahead << ", " << pause;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
