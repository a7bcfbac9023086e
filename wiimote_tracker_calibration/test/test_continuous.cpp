// A rig that corrects itself: a camera that was knocked or drifted comes back, and nothing else
// moves it.

#include "expect_says.h"
#include "misled_trial.h"
#include "pixel_distance.h"
#include "waved_led.h"

#include "continuous/adjustment.h"
#include "continuous/continuous_calibration.h"
#include "continuous/keyframes.h"
#include "continuous/motion_window.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

using square::Random;
using square::uniform;

constexpr double kDegree = M_PI / 180.0;

/// The first proposal until a time [s].
std::optional<Proposal> proposalUntil(double time, WavedLed* led, ContinuousCalibration* watch) {
  std::optional<Proposal> first;
  led->runUntil(time, [&](const capture::Image& image) {
    if (!first)
      first = watch->add(image);
  });
  return first;
}

TEST(Continuous, BringsBackAKnockedCamera) {
  Random random(1);
  for (std::size_t index = 0; index < 4; ++index) {
    geometry::Rig rig = paperRigWith(wellCalibrated());
    rig.verdict = "good; since then something else";
    WavedLed led(drawTruth(rig, random), 100 + index);
    ContinuousCalibration watch(rig, {});
    EXPECT_FALSE(proposalUntil(20.0, &led, &watch));
    led.truth[index] = turned(led.truth[index], uniform(random, 1.0, 3.0) * kDegree, random);
    const geometry::Camera& truth = led.truth[index].camera;
    const auto proposal = proposalUntil(40.0, &led, &watch);
    ASSERT_TRUE(proposal) << index;
    EXPECT_EQ(proposal->cause, Cause::kKnock);
    EXPECT_EQ(proposal->cameras, std::vector<std::string>{truth.name});
    EXPECT_SAYS(proposal->message, truth.name + " was turned by");
    EXPECT_EQ(proposal->rig.verdict, "good; since then " + proposal->message);
    EXPECT_LT(pixelDistance(proposal->rig.cameras[index].camera, truth), 1.0);
    // The others hold the world.
    for (std::size_t i = 0; i < 4; ++i) {
      const geometry::Camera& before = rig.cameras[i].camera;
      const geometry::Camera& now = proposal->rig.cameras[i].camera;
      EXPECT_EQ(before.world_from_camera.matrix() == now.world_from_camera.matrix(), i != index);
    }
  }
}

TEST(Continuous, FindsTheClockAndAKnockAfterAReconnect) {
  Random random(6);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 600);
  ContinuousCalibration watch(rig, {});
  std::uint32_t epoch = led.epoch;
  std::optional<Proposal> proposal;
  const auto run = [&](double time) {
    led.runUntil(time, [&](capture::Image image) {
      if (image.camera == led.truth[1].camera.name)
        image.clock_epoch = epoch;
      if (!proposal)
        proposal = watch.add(image);
    });
  };
  run(5.0);
  EXPECT_FALSE(proposal);
  epoch = 8;
  led.truth[1].time_offset = -0.015;
  led.truth[1] = turned(led.truth[1], 2.0 * kDegree, random);
  run(25.0);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->cause, Cause::kReconnect);
  EXPECT_EQ(proposal->cameras, std::vector<std::string>{led.truth[1].camera.name});
  const geometry::RigCamera& found = proposal->rig.cameras[1];
  EXPECT_EQ(found.time_offset_epoch, 8U);
  EXPECT_NEAR(found.time_offset, led.truth[1].time_offset, 0.0005);
  // Seven seconds determine it to 0.05 degrees or 1.1 px.
  EXPECT_LT(pixelDistance(found.camera, led.truth[1].camera), 2.0);
}

TEST(Continuous, FindsSlowDrift) {
  Random random(2);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 200);
  led.truth[2] = turned(led.truth[2], 0.1 * kDegree, random);
  const geometry::Camera& truth = led.truth[2].camera;
  ContinuousCalibration watch(rig, {});
  const auto proposal = proposalUntil(120.0, &led, &watch);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->cause, Cause::kDrift);
  EXPECT_GT(proposal->gain, kWorthAsking);
  EXPECT_SAYS(proposal->message, "drift, or errors of the calibration");
  EXPECT_EQ(proposal->cameras, std::vector<std::string>{truth.name});
  EXPECT_LT(pixelDistance(proposal->rig.cameras[2].camera, truth),
            0.5 * pixelDistance(rig.cameras[2].camera, truth));
}

TEST(ExtensiveContinuous, NobodyIsAskedWhenClocksWander) {
  constexpr double kWander = 0.001;  // [s]
  constexpr double kTime = 60.0;     // Over which it is correlated [s].
  constexpr double kRate = 50.0;     // Images of a camera [Hz].
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    const geometry::Rig rig = paperRigWith(calibratedByWave());
    WavedLed led(drawTruth(rig, random), 300 + seed, kRate);
    std::map<std::string, double> wander;
    ContinuousCalibration watch(rig, {});
    const auto add = [&](capture::Image image) {
      double& error = wander[image.camera];
      error += -error / (kTime * kRate) +
               square::normal(random, kWander * std::sqrt(2.0 / (kTime * kRate)));
      image.stamp += error;
      return watch.add(image);
    };
    led.runUntil(75.0, [&](const capture::Image& image) {
      const auto proposal = add(image);
      ASSERT_TRUE(!proposal || proposal->cause == Cause::kDrift) << proposal->message;
      EXPECT_LT(proposal ? proposal->gain : 0.0, kWorthAsking) << proposal->message;
    });
    // It has taken these images: it notices a knock.
    led.truth[1] = turned(led.truth[1], 2.0 * kDegree, random);
    bool is_found = false;
    led.runUntil(95.0, [&](const capture::Image& image) {
      const auto proposal = is_found ? std::nullopt : add(image);
      is_found = is_found || (proposal && proposal->cause == Cause::kKnock);
    });
    EXPECT_TRUE(is_found) << seed;
  }
}

TEST(Continuous, AReconnectAloneKeepsThePoses) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(rig.cameras, 800);
  led.truth[1].time_offset = -0.015;
  ContinuousCalibration watch(rig, {});
  std::optional<Proposal> proposal;
  led.runUntil(40.0, [&](capture::Image image) {
    if (image.camera == led.truth[1].camera.name)
      image.clock_epoch = 8;
    if (!proposal)
      proposal = watch.add(image);
  });
  ASSERT_TRUE(proposal);
  EXPECT_EQ(proposal->cause, Cause::kReconnect);
  EXPECT_EQ(proposal->message.find("camera_2 has a new clock, -1"), 0U) << proposal->message;
  EXPECT_NEAR(proposal->rig.cameras[1].time_offset, -0.015, 0.0005);
  EXPECT_EQ(proposal->rig.cameras[1].time_offset_epoch, 8U);
  EXPECT_EQ(proposal->rig.solved_at, rig.solved_at);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(proposal->rig.cameras[i].camera.world_from_camera.matrix(),
              rig.cameras[i].camera.world_from_camera.matrix());
}

TEST(Continuous, ACameraWithoutATimeOffsetHasNotReconnected) {
  Random random(9);
  geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 900);
  for (std::size_t i = 0; i < 4; ++i) {
    rig.cameras[i].time_offset = std::nan("");
    rig.cameras[i].time_offset_rule = geometry::TimeOffsetRule::kNone;
    led.truth[i].time_offset = 0.0;
  }
  ContinuousCalibration watch(rig, {});
  std::vector<capture::Image> images;
  led.runUntil(45.0, [&](const capture::Image& image) {
    EXPECT_FALSE(watch.add(image));
    images.push_back(image);
  });
  const auto adjusted = adjustRig(rig, images);
  ASSERT_TRUE(adjusted);
  for (const geometry::RigCamera& camera : adjusted->cameras) {
    EXPECT_EQ(camera.time_offset_rule, geometry::TimeOffsetRule::kNone);
    EXPECT_TRUE(std::isnan(camera.time_offset));
  }
  EXPECT_LT(fitOf(*adjusted, images).value().misfit, fitOf(rig, images).value().misfit);
}

TEST(Continuous, TheMisfitOfASquareAloneIsNotTakenForDrift) {
  constexpr double kSlower = 4.0;  // so that cameras without time offsets are judged
  geometry::Rig rig = paperRigWith(RigErrors());
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.time_offset = std::nan("");
    camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
  }
  Random random(3);
  for (std::uint64_t seed = 300; seed < 304; ++seed) {
    WavedLed led(drawTruth(rig, random), seed, 50.0 * kSlower);
    for (geometry::RigCamera& camera : led.truth)
      camera.time_offset = 0.0;
    ContinuousCalibration watch(rig, {});
    const auto add = [&](capture::Image image) {
      image.stamp = WavedLed::kClock + kSlower * (image.stamp - WavedLed::kClock);
      return watch.add(image);
    };
    led.runUntil(60.0 / kSlower, [&](const capture::Image& image) {
      const auto proposal = add(image);
      EXPECT_FALSE(proposal) << proposal->message;
    });
    // It has taken these images: a knock makes a camera suspect.
    Proposal knock;
    knock.cause = Cause::kKnock;
    knock.cameras = {led.truth[1].camera.name};
    EXPECT_FALSE(watch.isCurrent(knock)) << seed;
    Random turns(seed);
    led.truth[1] = turned(led.truth[1], 2.0 * kDegree, turns);
    led.runUntil(80.0 / kSlower, add);
    EXPECT_TRUE(watch.isCurrent(knock)) << seed;
  }
}

TEST(Continuous, ASolvedCameraIsAsUncertainAsTheDriftOfTheOthers) {
  // Standard deviation of a knocked camera's rotation, hours after the rig was solved [rad].
  const auto rotation = [](double hours) {
    Random random(3);
    geometry::Rig rig = paperRigWith(wellCalibrated());
    rig.solved_at = WavedLed::kClock - 3600.0 * hours;
    WavedLed led(drawTruth(rig, random), 300);
    led.truth[0] = turned(led.truth[0], 2.0 * kDegree, random);
    ContinuousCalibration watch(rig, {});
    const Proposal proposal = proposalUntil(20.0, &led, &watch).value();
    return std::sqrt(proposal.rig.covariance.topLeftCorner<3, 3>().trace());
  };
  // 0.5 mrad an hour about each axis; the other cameras count together.
  EXPECT_GT(rotation(2.0), 0.0005 + rotation(0.0));
}

TEST(Continuous, IsAFunctionOfTheImages) {
  const auto run = [] {
    Random random(3);
    const geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed led(drawTruth(rig, random), 300);
    led.truth[0] = turned(led.truth[0], 2.0 * kDegree, random);
    ContinuousCalibration watch(rig, {});
    return proposalUntil(20.0, &led, &watch).value();
  };
  const Proposal first = run();
  const Proposal second = run();
  EXPECT_EQ(first.rig.id(), second.rig.id());
  EXPECT_EQ(first.rig.covariance, second.rig.covariance);
  EXPECT_EQ(first.rig.solved_at, second.rig.solved_at);
  EXPECT_EQ(first.message, second.message);
}

TEST(Continuous, ProposesNothingWithoutMotion) {
  Random random(4);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 400);
  ContinuousCalibration watch(rig, {});
  // Knocked while the LED rests.
  led.still = Eigen::Vector3d(1.0, 1.1, 0.9);
  led.wrong_share = 0.0;
  led.truth[1] = turned(led.truth[1], 2.0 * kDegree, random);
  EXPECT_FALSE(proposalUntil(600.0, &led, &watch));
  // Moved for five seconds only, then at rest again.
  led.still.reset();
  EXPECT_FALSE(proposalUntil(605.0, &led, &watch));
  led.still = Eigen::Vector3d(1.0, 1.1, 0.9);
  EXPECT_FALSE(proposalUntil(900.0, &led, &watch));
  // The motion of both times counts.
  led.still.reset();
  EXPECT_TRUE(proposalUntil(915.0, &led, &watch));
  EXPECT_EQ(changesAtRest(true, 2, 1) + changesAtRest(false, 2, 2), 0);
}

TEST(Continuous, JudgesTheMotionAfterAPause) {
  // A knock is found after so many seconds of motion, with a long pause before the last 4.5, too.
  const auto found = [](double pause_at) {
    Random random(10);
    const geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed led(drawTruth(rig, random), 1000);
    led.truth[1] = turned(led.truth[1], 2.0 * kDegree, random);
    Options options;
    options.suspects.motion = {140, 120};
    ContinuousCalibration watch(rig, options);
    double end = 0.0;
    led.runUntil(40.0, [&](capture::Image image) {
      if (image.stamp > WavedLed::kClock + pause_at)
        image.stamp += 600.0;
      if (end == 0.0 && watch.add(image))
        end = image.stamp - WavedLed::kClock;
    });
    return end;
  };
  const double without = found(40.0);
  ASSERT_GT(without, 10.0);
  EXPECT_NEAR(found(without - 4.5), without + 600.0, 1.0);
}

TEST(Continuous, ForgetsMotionAfterAnHour) {
  MotionWindow window({20, 10});
  double step = 0.0;
  // Three cameras see an LED that moves.
  const auto isEnoughUntil = [&](double begin, double end) {
    bool is_enough = false;
    for (double time = begin; time < end; time += 0.025) {
      step += 3.0;
      for (const char* name : {"a", "b", "c"})
        is_enough = window.add({name, time, 7, {Eigen::Vector2d(step, 0.0)}, {}}) || is_enough;
    }
    return is_enough;
  };
  EXPECT_FALSE(isEnoughUntil(0.0, 1.0));
  EXPECT_FALSE(isEnoughUntil(4000.0, 4001.0));
  EXPECT_TRUE(isEnoughUntil(4100.0, 4101.0));
  // The clock is set.
  EXPECT_FALSE(isEnoughUntil(1.7e9, 1.7e9 + 1.0));
}

TEST(Continuous, ASlowLedTakesLittleMemory) {
  MotionWindow window({20, 10});
  // Images each 10 ms, a sample each half second.
  bool is_enough = false;
  for (int i = 0; i < 2000 && !is_enough; ++i) {
    const int step = i / 50;
    for (const char* name : {"a", "b", "c"})
      is_enough = window.add({name, 0.01 * i, 7, {Eigen::Vector2d(2.0 * step, 0.0)}, {}});
  }
  ASSERT_TRUE(is_enough);
  const MotionImages images = window.images();
  EXPECT_NEAR(static_cast<double>(images.to_solve.size()), 20 * 3 * 20, 60.0);
}

}  // namespace
}  // namespace wiimote_tracker::continuous
