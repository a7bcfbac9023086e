// Continuous calibration where two cameras were moved.
#include "expect_says.h"
#include "knock_trial.h"
#include "waved_led.h"

#include "continuous/continuous_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

using square::Random;

constexpr double kOneDegree = M_PI / 180.0;

Knock twoTurnedBy(double degrees) {
  Knock knock;
  knock.turn = degrees * kOneDegree;
  knock.knocked = 2;
  return knock;
}

/// A rig of four, of which two cameras stand on a shelf that was turned.
class Shelf : public ::testing::Test {
 protected:
  Shelf() : random_(1), rig_(paperRigWith(wellCalibrated())), led_(drawTruth(rig_, random_), 100) {
    const Eigen::Vector3d center = led_.truth[0].camera.center();
    const Eigen::Isometry3d turn = Eigen::Translation3d(center) *
                                   Eigen::AngleAxisd(2.0 * kOneDegree, Eigen::Vector3d::UnitX()) *
                                   Eigen::Translation3d(-center);
    for (const std::size_t i : {0, 1}) {
      Eigen::Isometry3d& pose = led_.truth[i].camera.world_from_camera;
      pose = turn * pose;
    }
  }

  /// @param with_gravity whether the accelerometers are read.
  std::optional<Proposal> proposal(bool with_gravity, ContinuousCalibration* watch) {
    std::optional<Proposal> first;
    led_.runUntil(30.0, [&](const capture::Image& image) {
      const auto index = static_cast<std::size_t>(rig_.find(image.camera) - rig_.cameras.data());
      const Eigen::Isometry3d& pose = led_.truth[index].camera.world_from_camera;
      if (with_gravity)
        watch->addAcceleration(image.camera, 9.81 * pose.linear().row(2).transpose());
      if (!first)
        first = watch->add(image);
    });
    return first;
  }

  Random random_;
  geometry::Rig rig_;
  WavedLed led_;
};

TEST(ContinuousTwo, BringsBackTwoKnockedCameras) {
  for (const std::uint64_t seed : {0, 1, 3, 8}) {
    const KnockTrial trial = runKnockTrial(twoTurnedBy(2.0), seed);
    EXPECT_TRUE(trial.found && !trial.others) << seed;
    EXPECT_LT(trial.seconds, 20.0) << seed;
    EXPECT_LT(trial.error, 0.006) << seed;
  }
}

// They locate the LED only far from the line between them. False detections elsewhere were taken
// for a contradiction of the two.
TEST(ContinuousTwo, TwoThatFaceEachOtherSolveTheOthers) {
  for (const std::uint64_t seed : {4, 7, 16}) {
    const KnockTrial trial = runKnockTrial(twoTurnedBy(2.0), seed);
    EXPECT_TRUE(trial.found && !trial.others) << seed;
    EXPECT_LT(trial.error, 0.006) << seed;
  }
}

TEST(ContinuousTwo, BringsBackASecondCameraThatWasKnockedSoonAfterTheFirst) {
  Knock knock = twoTurnedBy(2.0);
  knock.pause = 5.0;
  const KnockTrial trial = runKnockTrial(knock, 0);
  EXPECT_TRUE(trial.found && !trial.others);
  EXPECT_LT(trial.error, 0.006);
}

TEST(ContinuousTwo, TheLargerGroupHoldsTheWorld) {
  Knock knock = twoTurnedBy(1.0);
  knock.together = true;
  knock.cameras = 5;
  const KnockTrial trial = runKnockTrial(knock, 0);
  EXPECT_TRUE(trial.found && !trial.others);
  EXPECT_LT(trial.error, 0.006);
}

TEST_F(Shelf, DoesNotGuessWhichPairWasMoved) {
  ContinuousCalibration watch(rig_, {});
  EXPECT_FALSE(proposal(false, &watch));
  EXPECT_SAYS(watch.contradiction(), "contradict the others");
  EXPECT_SAYS(watch.contradiction(), "calibrate all cameras again");
}

TEST_F(Shelf, AccelerometersSayWhichPairWasMoved) {
  ContinuousCalibration watch(rig_, {});
  const auto found = proposal(true, &watch);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cause, Cause::kKnock);
  EXPECT_EQ(found->cameras, std::vector<std::string>({"camera_1", "camera_2"}));
  EXPECT_SAYS(found->message, "camera_2 was turned by");
  for (const std::size_t i : {2, 3})
    EXPECT_EQ(found->rig.cameras[i].camera.world_from_camera.matrix(),
              rig_.cameras[i].camera.world_from_camera.matrix());
}

}  // namespace
}  // namespace wiimote_tracker::continuous
