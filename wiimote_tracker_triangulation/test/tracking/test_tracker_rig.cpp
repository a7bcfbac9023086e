// A rig that changes a little, as with each step of a continuous calibration, disturbs nothing.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

/// The next step: no place moves by more than 0.2 mm, and the clocks are known a little better.
geometry::Rig nextStep(geometry::Rig rig) {
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.camera.world_from_camera.pretranslate(Eigen::Vector3d(0.0002, 0.0, 0.0));
    if (camera.time_offset_rule != geometry::TimeOffsetRule::kNone)
      camera.time_offset += 0.0001;
  }
  return rig;
}

TEST(TrackerRig, AStepKeepsWhatIsKnownOfTheClocks) {
  constexpr double kOffset = 0.004;  // of camera 1, which reconnects after 1 s [s]
  geometry::Rig rig = paperRig();
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.time_offset = 0.0;
    camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  }
  const SceneOptions options;
  Scene scene(rig, wanderers(2, 1, 0.5), options, 1);
  Tracker tracker(rig, exactOptions());
  bool has_stepped = false;
  std::size_t compared = 0;
  for (double time = 0.0; time < 7.0;) {
    SceneImage image = scene.next();
    time = image.true_time - options.start;
    if (image.camera == 1 && time >= 1.0) {
      image.image.stamp += kOffset;
      image.image.clock_epoch = 1;
    }
    if (time >= 6.0 && !has_stepped) {
      tracker.setRig(nextStep(rig));
      has_stepped = true;
    }
    tracker.add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker.next()) {
      if (image.camera != 1 || time < 5.9)
        continue;
      const CameraView& view = snapshot->views[1];
      EXPECT_NEAR(image.true_time, *view.time, 0.001) << time;
      EXPECT_LT(view.stamp_stddev, 0.001) << time;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100u);
}

TEST(TrackerRig, AKnockedCameraStaysLeftOutUntilItsPlaceIsCalibrated) {
  const geometry::Rig rig = paperRig();
  geometry::Rig knocked = rig;
  knocked.cameras[1].camera.world_from_camera.rotate(
      Eigen::AngleAxisd(2.0 * M_PI / 180.0, Eigen::Vector3d::UnitX()));
  const std::vector<Path> leds = wanderers(4, 1);
  const SceneOptions options;
  Scene before(rig, leds, options, 2);
  Scene after(knocked, leds, options, 2);  // exposes at the same times
  Tracker tracker(rig, exactOptions());
  const auto isMisfit = [&] {
    const auto fault = tracker.cameraFault(1);
    return fault && fault->kind == CameraFault::Kind::kMisfit;
  };
  Snapshot last;
  const auto filmUntil = [&](double end, bool expected) {
    for (double time = 0.0; time < end;) {
      const SceneImage right = before.next();
      const SceneImage& wrong = after.next();
      time = right.true_time - options.start;
      tracker.add(right.camera, time < 2.0 ? right.image : wrong.image);
      while (const Snapshot* snapshot = tracker.next())
        last = *snapshot;
      if (time > 4.0) {
        ASSERT_EQ(expected, isMisfit()) << time;
      }
    }
  };
  filmUntil(4.0, true);
  ASSERT_TRUE(isMisfit());
  tracker.setRig(nextStep(rig));
  EXPECT_TRUE(isMisfit());
  filmUntil(4.5, true);
  tracker.setRig(nextStep(knocked));
  EXPECT_FALSE(isMisfit());
  filmUntil(5.5, false);
  const auto seen = std::count_if(last.leds.begin(), last.leds.end(), [](const TrackedLed& led) {
    return std::count(led.cameras.begin(), led.cameras.end(), 1u) == 1;
  });
  EXPECT_GE(seen, 3) << "it is used again";
}

/// As after a new square: the old places would be wrong in the new world.
TEST(TrackerRig, NoLedIsTrackedInAnotherWorldBeforeItIsSeenThere) {
  geometry::Rig shifted = paperRig();
  for (geometry::RigCamera& camera : shifted.cameras)
    camera.camera.world_from_camera.pretranslate(Eigen::Vector3d(1.0, 0.0, 0.0));
  Scene scene(paperRig(), wanderers(3, 1), {}, 3);
  Tracker tracker(paperRig(), exactOptions());
  const auto trackedUntil = [&](double end, const Eigen::Vector3d& shift) {
    std::size_t tracked = 0;
    for (double time = 0.0; time < end;) {
      const SceneImage& image = scene.next();
      time = image.true_time - SceneOptions().start;
      tracker.add(image.camera, image.image);
      while (const Snapshot* snapshot = tracker.next()) {
        for (const TrackedLed& led : snapshot->leds) {
          if (led.state != TrackState::kTracked)
            continue;
          const bool is_right =
              std::any_of(scene.leds().begin(), scene.leds().end(), [&](const Path& path) {
                return (led.position - shift - path(snapshot->time)).norm() < 0.05;
              });
          EXPECT_TRUE(is_right) << time;
          ++tracked;
        }
      }
    }
    return tracked;
  };
  EXPECT_GT(trackedUntil(1.0, Eigen::Vector3d::Zero()), 1000u);
  tracker.setRig(shifted);
  EXPECT_GT(trackedUntil(1.5, Eigen::Vector3d(1.0, 0.0, 0.0)), 400u);
}

TEST(TrackerRig, AWrongClockStaysKnownWhenCamerasAreMoved) {
  std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(3, 12), {}, 1200);
  geometry::Rig moved = paperRig();
  moved.cameras[0].camera.world_from_camera.pretranslate(Eigen::Vector3d(0.1, 0.0, 0.0));
  Tracker tracker(paperRig(), exactOptions());
  std::uint64_t wrong = 0;
  std::uint64_t dropped = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const bool is_wrong = images[i].camera == 2;
    images[i].image.stamp += is_wrong ? 0.3 : 0.0;
    images[i].image.arrival += is_wrong ? 0.3 : 0.0;
    if (i >= 600 && is_wrong && wrong++ == 0) {  // it sends the first image after the new rig
      tracker.setRig(moved);
      dropped = tracker.counters().dropped;
    }
    tracker.add(images[i].camera, images[i].image);
  }
  EXPECT_EQ(tracker.counters().dropped - dropped, wrong);
}

TEST(TrackerRig, AStepLosesNoTrackAndNoLateImage) {
  const std::vector<SceneImage> images = imagesOf(paperRig(), wanderers(3, 12), {}, 1200);
  constexpr std::size_t kStep = 600;
  constexpr std::size_t kLate = kStep - 10;
  Tracker tracker(paperRig(), exactOptions());
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (i == kStep) {
      tracker.setRig(nextStep(paperRig()));
      tracker.add(images[kLate].camera, images[kLate].image);
      EXPECT_EQ(1u, tracker.counters().late) << "it is used at its own time";
    }
    if (i != kLate)
      tracker.add(images[i].camera, images[i].image);
    while (const Snapshot* snapshot = tracker.next()) {
      if (i >= kStep - 100) {
        EXPECT_EQ((std::set<std::uint32_t>{0, 1, 2}), idsIn(*snapshot, TrackState::kTracked)) << i;
      }
    }
  }
  EXPECT_EQ(0u, tracker.counters().dropped);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
