// False detections and reflections never become LEDs.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

struct PhantomRows {
  std::size_t tracked = 0;
  std::size_t wrong = 0;
};

/// @param seen as LEDs by the cameras, some of them phantoms
PhantomRows rowsOf(const geometry::Rig& rig,
                   const std::vector<Path>& seen,
                   const std::vector<Path>& leds,
                   const SceneOptions& options,
                   int images,
                   unsigned seed) {
  Tracker tracker(rig, exactOptions());
  IdentityCheck check(leds);
  PhantomRows rows;
  for (const Snapshot& snapshot : track(&tracker, imagesOf(rig, seen, options, images, seed))) {
    rows.tracked += idsIn(snapshot, TrackState::kTracked).size();
    check.add(snapshot);
  }
  rows.wrong = check.false_tracks;
  return rows;
}

TEST(TrackerPhantoms, TwoReflectionsMakeNoLedWhereOtherCamerasSeeNone) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<Path> leds = wanderers(2, seed);
    const Path phantom = circle({0.9, 1.6, 1.2}, 0.3, 0.6);
    // In mirrors, of which one camera sees each: their rays miss each other by up to 3 px.
    const Path other = [phantom](double t) {
      return Eigen::Vector3d(phantom(t) + Eigen::Vector3d(0.0, 0.0, 0.015 * std::sin(1.3 * t)));
    };
    SceneOptions options;
    options.hidden = [](std::size_t camera, std::size_t led, double) {
      return (led == 2 && camera != 0) || (led == 3 && camera != 1);
    };
    const PhantomRows rows =
        rowsOf(paperRig(), {leds[0], leds[1], phantom, other}, leds, options, 8000, seed);
    EXPECT_GT(rows.tracked, 14000u);
    EXPECT_EQ(0u, rows.wrong) << "seed " << seed;
  }
}

// A phantom of rays that meet exactly cannot be told from it.
TEST(TrackerPhantoms, AnLedThatIsHiddenFromTheOtherCamerasIsConfirmedLater) {
  for (const double speed : {0.3, 3.0}) {
    const std::vector<Path> leds = wanderers(2, 4, speed);
    SceneOptions options;
    options.hidden = [](std::size_t camera, std::size_t, double) { return camera >= 2; };
    const PhantomRows rows = rowsOf(paperRig(), leds, leds, options, 4000, 4);
    EXPECT_GE(rows.tracked, 2u * 4000 * 93 / 100) << speed;  // all but the first 0.7 s of 10 s
    EXPECT_EQ(0u, rows.wrong) << speed;
  }
}

/// The calibration tells how inexact the cameras' spots are.
TEST(TrackerPhantoms, SoIsOneBeforeNoisyCameras) {
  constexpr double kNoise = 1.5;  // five times that of the options [px]
  geometry::Rig rig = paperRig();
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.inliers = 1000;
    camera.residual_px = std::sqrt(2.0) * kNoise;
  }
  const std::vector<Path> leds = wanderers(2, 4, 0.3);
  SceneOptions options;
  options.pixel_noise = kNoise;
  options.hidden = [](std::size_t camera, std::size_t, double) { return camera >= 2; };
  const PhantomRows rows = rowsOf(rig, leds, leds, options, 4000, 4);
  EXPECT_GE(rows.tracked, 2u * 4000 * 85 / 100);  // all but the first second or so of 10 s
}

TEST(TrackerPhantoms, AnLedThatTheOtherCamerasCannotSeeIsConfirmedAtOnce) {
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  geometry::Rig rig = paperRig();
  for (std::size_t i = 2; i < 4; ++i)
    rig.cameras[i].masks.push_back({*rig.cameras[i].camera.project(place), 30.0});
  const PhantomRows rows = rowsOf(rig, {still(place)}, {still(place)}, SceneOptions(), 4000, 1);
  EXPECT_GE(rows.tracked, 4000u * 99 / 100);
}

// In a vertical plane through two cameras that face each other: each sees one spot of both LEDs,
// and its rays meet between them.
TEST(TrackerPhantoms, TwoLedsThatTwoCamerasShowAsOneSpotMakeNoThird) {
  struct Trial {
    Eigen::Vector3d first, second;
    double merging_distance;
  };
  for (const Trial& trial : {Trial{{1.0, 1.0, 1.0}, {1.6, 1.6, 1.0}, 24.0},
                             Trial{{1.0, 1.0, 1.0}, {1.6, 1.6, 1.0}, 32.0},
                             Trial{{1.0, 1.0, 1.1}, {1.6, 1.65, 1.1}, 32.0},
                             Trial{{1.5, 1.0, 1.2}, {0.9, 1.6, 1.2}, 32.0},
                             Trial{{0.6, 0.6, 1.2}, {1.5, 1.5, 1.2}, 40.0}}) {
    const std::vector<Path> leds = {still(trial.first), still(trial.second)};
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
      SceneOptions options;
      options.merging_distance = trial.merging_distance;
      options.integer_pixels = true;
      if (seed > 2) {  // by a bad radio
        options.lost_images = 0.2;
        options.dropout = 0.1;
      }
      const auto images = imagesOf(paperRig(), leds, options, 4000, seed);
      Tracker tracker(paperRig(), exactOptions());
      IdentityCheck check(leds);
      for (const SceneImage& image : images) {
        tracker.add(image.camera, image.image);
        while (const Snapshot* snapshot = tracker.next())
          check.add(*snapshot);
        ASSERT_FALSE(tracker.cameraFault(image.camera)) << trial.second.transpose();
      }
      EXPECT_EQ(0u, check.false_tracks) << trial.second.transpose() << ", seed " << seed;
      EXPECT_GT(check.near, 7400u) << trial.second.transpose() << ", seed " << seed;
    }
  }
}

// Each camera shows four of twelve: none contradicts where rays of two LEDs meet by chance. It is
// 10 % where full cameras count as if they did not look there.
TEST(ExtensiveTrackerPhantoms, LedsThatCrowdEachOtherOutMakeFew) {
  PhantomRows all;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    geometry::test::Random random(seed);
    std::vector<Path> leds;
    for (int i = 0; i < 12; ++i) {
      const int column = i % 4, row = i / 4;
      const Eigen::Vector3d place(0.5 + 0.5 * column, 0.6 + 0.6 * row, 1.0);
      leds.push_back(wandering(random, place, 0.2, 0.5));
    }
    const PhantomRows rows = rowsOf(paperRig(), leds, leds, SceneOptions(), 4000, seed);
    all.tracked += rows.tracked;
    all.wrong += rows.wrong;
  }
  EXPECT_GT(all.tracked, 95000u);
  EXPECT_LE(all.wrong, 0.085 * all.tracked) << all.tracked;
}

TEST(TrackerPhantoms, AHiddenLedIsNotFoundOnGhosts) {
  PhantomRows all;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<Path> leds = wanderers(2, seed);
    SceneOptions options;
    options.ghosts = 0.5;
    options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 0.8) < 0.4; };
    const PhantomRows rows = rowsOf(paperRig(), leds, leds, options, 8000, seed);
    all.tracked += rows.tracked;
    all.wrong += rows.wrong;
  }
  EXPECT_GT(all.tracked, 15000u);
  EXPECT_LE(all.wrong, 1e-4 * all.tracked);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
