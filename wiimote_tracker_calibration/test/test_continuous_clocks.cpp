// Continuous calibration while several cameras have new clocks, as after a start.
#include "expect_says.h"
#include "pixel_distance.h"
#include "waved_led.h"

#include "continuous/adjustment.h"
#include "continuous/continuous_calibration.h"

#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

/// [rad]
double turnBetween(const geometry::RigCamera& a, const geometry::RigCamera& b) {
  return geometry::so3::angleBetween(a.camera.world_from_camera.linear(),
                                     b.camera.world_from_camera.linear());
}

/// Errors of the clocks against the first one, in standard deviations: their squares' sum, which
/// has a mean of three.
double clockNees(const geometry::Rig& rig, const std::vector<geometry::RigCamera>& truth) {
  Eigen::MatrixXd against_first = Eigen::MatrixXd::Zero(3, rig.covariance.rows());
  against_first.col(geometry::kTimeOffset).setConstant(-1.0);
  Eigen::Vector3d errors;
  for (std::size_t i = 1; i < 4; ++i) {
    const auto row = static_cast<Eigen::Index>(i - 1);
    against_first(row, geometry::firstParameter(i) + geometry::kTimeOffset) = 1.0;
    errors[row] = rig.cameras[i].time_offset - rig.cameras[0].time_offset -
                  (truth[i].time_offset - truth[0].time_offset);
  }
  return geometry::squaredMahalanobis(errors, geometry::propagated(against_first, rig.covariance));
}

// The limits of the following two tests are for all runs together, since what one run finds varies.
// Sets of as many runs, drawn from 100 others, exceed each limit one time in 1,000.

TEST(Continuous, AdjustsAllCamerasAndTheirNewClocks) {
  constexpr int kRuns = 16;
  std::array<std::vector<double>, 4> left;  // Of each camera's error, share.
  std::vector<double> all_left;
  double pose_nees = 0.0;
  double clock_nees = 0.0;
  for (std::uint64_t seed = 700; seed < 700 + kRuns; ++seed) {
    square::Random random(seed);
    const geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed led(drawTruth(rig, random), seed + 1000);
    led.epoch = 8;
    for (geometry::RigCamera& camera : led.truth) {
      camera = turned(camera, 0.0009, random);
      camera.time_offset = square::uniform(random, -0.01, 0.01);
    }
    ContinuousCalibration watch(rig, {});
    std::optional<Proposal> proposal;
    led.runUntil(60.0, [&](const capture::Image& image) {
      if (!proposal)
        proposal = watch.add(image);
    });
    ASSERT_TRUE(proposal) << seed;
    EXPECT_EQ(proposal->cause, Cause::kReconnect);
    EXPECT_SAYS(proposal->message, " turned by 0.0");
    clock_nees += clockNees(proposal->rig, led.truth) / (3.0 * kRuns);
    for (std::size_t i = 0; i < 4; ++i) {
      const geometry::RigCamera& found = proposal->rig.cameras[i];
      const geometry::Camera& truth = led.truth[i].camera;
      left[i].push_back(pixelDistance(found.camera, truth) /
                        pixelDistance(rig.cameras[i].camera, truth));
      all_left.push_back(left[i].back());
      pose_nees += square::poseNees(proposal->rig, i, truth) / (24.0 * kRuns);
      // Of what all clocks did together nothing is stated.
      const Eigen::Index clock = geometry::firstParameter(i) + geometry::kTimeOffset;
      EXPECT_LT(std::sqrt(proposal->rig.covariance(clock, clock)), 0.0002) << seed;
    }
  }
  EXPECT_LT(medianOf(&all_left), 0.45);
  for (std::vector<double>& of_camera : left)
    EXPECT_LT(medianOf(&of_camera), 0.65);
  EXPECT_LT(pose_nees, 1.3);
  EXPECT_LT(clock_nees, 1.0);  // It is 0.5: stamps have no errors here, but are granted some.
}

/// A camera that was turned while the computer was off.
TEST(Continuous, AmongNewClocksAKnockIsSolvedAfterThem) {
  constexpr int kRuns = 8;
  constexpr double kTurn = 0.03;  // [rad]
  std::vector<double> turns;
  double nees = 0.0;
  for (std::uint64_t seed = 800; seed < 800 + kRuns; ++seed) {
    square::Random random(seed);
    geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed led(drawTruth(rig, random), seed + 1000);
    led.epoch = 8;
    led.truth[1] = turned(led.truth[1], kTurn, random);
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
    ASSERT_TRUE(proposal) << seed;
    EXPECT_EQ(proposal->cause, Cause::kReconnect);
    EXPECT_EQ(joined(watch->newClocks()), "camera_1, camera_2, camera_3, camera_4");
    EXPECT_FALSE(proposal->rig.cameras[0].hasNewClock(8));
    EXPECT_TRUE(proposal->rig.cameras[1].hasNewClock(8)) << "it has no place yet";
    EXPECT_GT(turnBetween(proposal->rig.cameras[1], led.truth[1]), 0.02);
    rig = proposal->rig;
    waveUntil(120.0);
    ASSERT_TRUE(proposal) << seed;
    EXPECT_EQ(joined(proposal->cameras), "camera_2");
    turns.push_back(turnBetween(proposal->rig.cameras[1], led.truth[1]));
    nees += square::poseNees(proposal->rig, 1, led.truth[1].camera);
  }
  EXPECT_LT(medianOf(&turns), 0.0017);
  EXPECT_LT(nees, 100.0);  // Of 48 degrees of freedom.
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
