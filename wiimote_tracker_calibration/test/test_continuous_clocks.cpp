// Continuous calibration while several cameras have new clocks, as after a start.
#include "waved_led.h"

#include "continuous/adjust_rig.h"
#include "continuous/continuous_calibration.h"

#include <wiimote_tracker_msgs/text.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

/// [rad]
double turnBetween(const geometry::RigCamera& a, const geometry::RigCamera& b) {
  return Eigen::AngleAxisd(a.camera.world_from_camera.linear().transpose() *
                           b.camera.world_from_camera.linear())
      .angle();
}

/// A camera that was turned while the computer was off.
TEST(Continuous, AmongNewClocksAKnockIsSolvedAfterThem) {
  square::Random random(8);
  geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 800);
  led.epoch = 8;
  led.truth[1] = turned(led.truth[1], 0.03, random);
  std::optional<ContinuousCalibration> watch;
  std::optional<Proposal> proposal;
  const auto waveUntil = [&](double time) {
    watch.emplace(rig, Options{});
    proposal.reset();
    led.runUntil(time, [&](const capture::Image& image) {
      if (!proposal)
        proposal = watch->add(image);
    });
  };
  waveUntil(60.0);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->cause, Cause::kReconnect);
  EXPECT_EQ(joined(watch->newClocks()), "camera_1, camera_2, camera_3, camera_4");
  EXPECT_FALSE(proposal->rig.cameras[0].hasNewClock(8));
  EXPECT_TRUE(proposal->rig.cameras[1].hasNewClock(8)) << "it has no place yet";
  EXPECT_GT(turnBetween(proposal->rig.cameras[1], led.truth[1]), 0.02);
  rig = proposal->rig;
  waveUntil(120.0);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(joined(proposal->cameras), "camera_2");
  EXPECT_LT(turnBetween(proposal->rig.cameras[1], led.truth[1]), 0.001);
}

/// As when somebody changes the batteries of one camera and bumps into another one.
TEST(Continuous, BesideOneNewClockAnotherKnockedCameraIsSolved) {
  square::Random random(9);
  geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 801);
  led.truth[1] = turned(led.truth[1], 0.03, random);
  std::vector<std::string> found;
  std::optional<ContinuousCalibration> watch(std::in_place, rig, Options{});
  led.runUntil(120.0, [&](capture::Image image) {
    image.clock_epoch = image.camera == "camera_1" ? 8 : 7;
    if (const auto proposal = watch->add(image)) {
      found.push_back(joined(proposal->cameras));
      rig = proposal->rig;
      watch.emplace(rig, Options{});
    }
  });
  ASSERT_GE(found.size(), 2u) << joined(found);
  EXPECT_EQ(found[0], "camera_1");
  EXPECT_EQ(found[1], "camera_2");
  EXPECT_LT(turnBetween(rig.cameras[1], led.truth[1]), 0.001);
}

/// A driver that was started again counts from 0, below the rig's epoch.
TEST(Continuous, AfterARestartOfTheDriversAReconnectIsNoticed) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(rig.cameras, 802);
  led.epoch = 0;
  ContinuousCalibration watch(rig, {});
  std::optional<Proposal> proposal;
  const auto waveUntil = [&](double time, std::uint32_t epoch_of_second) {
    led.runUntil(time, [&](capture::Image image) {
      if (image.camera == "camera_2")
        image.clock_epoch = epoch_of_second;
      if (!proposal)
        proposal = watch.add(image);
    });
  };
  waveUntil(20.0, 0);
  EXPECT_FALSE(proposal);
  EXPECT_TRUE(watch.newClocks().empty());
  led.truth[1].time_offset = -0.015;
  waveUntil(60.0, 1);
  EXPECT_EQ(joined(watch.newClocks()), "camera_2");
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->message.find("camera_2 has a new clock, -1"), 0U) << proposal->message;
  EXPECT_EQ(proposal->rig.cameras[0].time_offset_epoch, 0U);
  EXPECT_EQ(proposal->rig.cameras[1].time_offset_epoch, 1U);
}

/// As when remote and driver were off for the night: the same epoch, but another link.
TEST(Continuous, AClockThatChangedInTheSameEpochTurnsNoCamera) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  for (std::size_t index = 0; index < 4; ++index) {
    for (const double change : {-0.003, 0.003}) {
      WavedLed led(rig.cameras, 810 + index);
      led.truth[index].time_offset += change;
      ContinuousCalibration watch(rig, {});
      std::optional<Proposal> proposal;
      led.runUntil(60.0, [&](const capture::Image& image) {
        if (!proposal)
          proposal = watch.add(image);
      });
      ASSERT_TRUE(proposal) << index;
      EXPECT_EQ(proposal->cause, Cause::kDrift);
      EXPECT_EQ(joined(proposal->cameras), rig.cameras[index].camera.name) << proposal->message;
      const std::string start = rig.cameras[index].camera.name + " has a clock that changed by ";
      ASSERT_EQ(proposal->message.find(start), 0U) << proposal->message;
      EXPECT_NEAR(std::stod(proposal->message.substr(start.size())), 1000.0 * change, 1.2);
      EXPECT_EQ(proposal->rig.solved_at, rig.solved_at);
      for (std::size_t i = 0; i < 4; ++i) {
        const geometry::RigCamera& found = proposal->rig.cameras[i];
        EXPECT_EQ(turnBetween(found, rig.cameras[i]), 0.0) << proposal->message;
        EXPECT_NEAR(found.time_offset, led.truth[i].time_offset, 0.0012) << proposal->message;
      }
    }
  }
}

/// No image shows it: half of the clocks went on by as much as the others went back.
TEST(Continuous, ClocksThatChangeInOppositeDirectionsKeepTheTime) {
  constexpr double kChange = 0.002;  // [s]
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(rig.cameras, 820);
  for (std::size_t i = 0; i < 4; ++i)
    led.truth[i].time_offset += i % 2 == 0 ? kChange : -kChange;
  std::vector<capture::Image> images;
  led.runUntil(30.0, [&](const capture::Image& image) { images.push_back(image); });
  const auto adjusted = adjustRig(rig, images);
  ASSERT_TRUE(adjusted);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(adjusted->cameras[i].time_offset, led.truth[i].time_offset, 0.6 * kChange);
}

}  // namespace
}  // namespace wiimote_tracker::continuous
