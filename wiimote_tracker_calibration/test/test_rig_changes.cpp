// Rigs that continuous calibration puts into use, at once or in steps, and takes back.

#include "misled_trial.h"
#include "waved_led.h"

#include "capture/masks.h"
#include "continuous/rig_changes.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

using square::Random;

class RigChangesTest : public testing::Test {
 protected:
  RigChangesTest() { changes_.follow(rig_); }

  /// The rig with a camera that was knocked.
  Proposal knocked(std::size_t camera) {
    geometry::Rig rig = *rig_;
    rig.cameras[camera] = turned(rig.cameras[camera], 0.03, random_);
    return {Cause::kKnock, {rig.cameras[camera].camera.name}, rig, 0.0, "", {}};
  }

  /// The rig with all cameras turned a little.
  Proposal drifted() {
    geometry::Rig rig = *rig_;
    for (geometry::RigCamera& camera : rig.cameras)
      camera = turned(camera, 0.001, random_);
    return {Cause::kDrift, {}, rig, 0.5, "", {{1.25, 1.25, 1.25}}};
  }

  /// Puts a rig into use, if there is one.
  void use(const std::optional<geometry::Rig>& rig) {
    ASSERT_TRUE(rig);
    rig_ = rig;
  }

  Random random_{7};
  std::optional<geometry::Rig> rig_ = paperRigWith(wellCalibrated());
  RigChanges changes_;
};

TEST_F(RigChangesTest, GoesBackThroughAllChanges) {
  const std::string first = rig_->id();
  use(changes_.apply(knocked(0), *rig_));
  const std::string second = rig_->id();
  EXPECT_NE(second, first);
  use(changes_.apply(knocked(1), *rig_));
  EXPECT_TRUE(changes_.isInUse(rig_));

  for (const std::string& id : {second, first}) {
    use(changes_.revert(*rig_));
    EXPECT_EQ(rig_->id(), id);
    changes_.follow(rig_);
    EXPECT_TRUE(changes_.isReverted());
  }
  EXPECT_FALSE(changes_.revert(*rig_)) << "no change is left";
  use(changes_.apply(knocked(2), *rig_));
  EXPECT_FALSE(changes_.isReverted()) << "somebody has asked for this change";
}

TEST_F(RigChangesTest, KeepsACorrectionOfTheVolumeThatIsNewerThanTheChange) {
  use(changes_.apply(knocked(0), *rig_));
  rig_->remap.emplace();
  rig_->remap->rig_id = rig_->id();
  use(changes_.revert(*rig_));
  ASSERT_TRUE(rig_->remap);
  EXPECT_EQ(rig_->remap->rig_id, rig_->id());
}

TEST_F(RigChangesTest, TakesNothingBackThatSomeoneElseHasMade) {
  use(changes_.apply(knocked(0), *rig_));
  rig_->cameras[0] = turned(rig_->cameras[0], 0.01, random_);
  EXPECT_FALSE(changes_.isInUse(rig_));
  EXPECT_FALSE(changes_.revert(*rig_));
}

TEST_F(RigChangesTest, ApproachesARigUntilItIsReached) {
  const Proposal proposal = drifted();
  EXPECT_FALSE(changes_.step(*rig_, 0.0)) << "nothing is approached";
  EXPECT_FALSE(changes_.apply(proposal, *rig_)) << "not at once";
  EXPECT_EQ(changes_.goal(*rig_).id(), proposal.rig.id());
  for (double stamp = 0.0; changes_.isApproaching() && stamp < 1e4; stamp += Approach::kPeriod) {
    use(changes_.step(*rig_, stamp));
    changes_.follow(rig_);
  }
  EXPECT_EQ(rig_->id(), proposal.rig.id());
  EXPECT_EQ(changes_.goal(*rig_).id(), rig_->id());
}

TEST_F(RigChangesTest, UsesAClockAtOnce) {
  Proposal proposal = drifted();
  EXPECT_FALSE(changes_.apply(proposal, *rig_));
  use(changes_.step(*rig_, 0.0));
  proposal.rig = *rig_;
  proposal.rig.cameras[0].time_offset += 0.003;
  use(changes_.apply(proposal, *rig_));
  EXPECT_EQ(rig_->id(), proposal.rig.id());
  EXPECT_FALSE(changes_.isApproaching());
}

TEST_F(RigChangesTest, GoesBackFromTheMiddleOfAnApproach) {
  const std::string first = rig_->id();
  EXPECT_FALSE(changes_.apply(drifted(), *rig_));
  use(changes_.step(*rig_, 0.0));
  EXPECT_NE(rig_->id(), first);
  use(changes_.revert(*rig_));
  EXPECT_EQ(rig_->id(), first);
  EXPECT_FALSE(changes_.isApproaching());
}

TEST_F(RigChangesTest, EndsAnApproachWhenSomeoneReplacesTheRig) {
  EXPECT_FALSE(changes_.apply(drifted(), *rig_));
  use(changes_.step(*rig_, 0.0));
  changes_.follow(rig_);
  EXPECT_TRUE(changes_.isApproaching());
  changes_.follow(paperRigWith(wellCalibrated()));
  EXPECT_FALSE(changes_.isApproaching());
}

TEST_F(RigChangesTest, CorrectsAKnockedCameraAtOnceDuringAnApproach) {
  EXPECT_FALSE(changes_.apply(drifted(), *rig_));
  use(changes_.step(*rig_, 0.0));
  const geometry::Rig before = *rig_;
  const Proposal proposal = knocked(3);
  use(changes_.apply(proposal, *rig_));
  const auto pose = [](const geometry::Rig& rig, std::size_t camera) {
    return rig.cameras[camera].camera.world_from_camera.matrix();
  };
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((pose(*rig_, i) - pose(i == 3 ? proposal.rig : before, i)).norm(), 1e-9) << i;
  EXPECT_TRUE(changes_.isApproaching());
  EXPECT_EQ(changes_.goal(*rig_).id(), proposal.rig.id());
}

// Masks move no point.
TEST_F(RigChangesTest, KeepsMasksThatAreLearnedMeanwhile) {
  const Proposal proposal = knocked(0);
  rig_->cameras[2].masks = {{{100.0, 50.0}, 9.0}};
  changes_.follow(rig_);
  EXPECT_FALSE(changes_.isReverted());
  use(changes_.apply(proposal, *rig_));
  ASSERT_EQ(rig_->cameras[2].masks.size(), 1U);
  EXPECT_EQ(rig_->cameras[2].masks[0].radius, 9.0);

  rig_->cameras[2].masks.clear();
  EXPECT_TRUE(changes_.isInUse(rig_));
  use(changes_.revert(*rig_));
  EXPECT_TRUE(rig_->cameras[2].masks.empty());
}

TEST(AppliedRig, KeepsTheCorrectionOfTheVolume) {
  Random random(4);
  geometry::Rig rig = paperRigWith(wellCalibrated());
  geometry::Rig goal = rig;
  goal.cameras[0] = turned(goal.cameras[0], 0.001, random);
  rig.cameras[2].masks = {{{100.0, 50.0}, 9.0}};
  rig.remap.emplace();
  rig.remap->rig_id = rig.id();
  const geometry::Rig applied = appliedRig(goal, rig);
  EXPECT_EQ(applied.remap->rig_id, applied.id());
  EXPECT_NE(applied.id(), goal.id());
  EXPECT_EQ(idWithoutMasks(applied), idWithoutMasks(goal));
  EXPECT_NE(idWithoutMasks(applied), idWithoutMasks(rig));

  const geometry::Rig undone = capture::withMasks(rig, capture::masksOf(goal));
  EXPECT_TRUE(undone.cameras[2].masks.empty());
  EXPECT_EQ(undone.remap->rig_id, undone.id());
  EXPECT_EQ(idWithoutMasks(undone), idWithoutMasks(rig));
}

}  // namespace
}  // namespace wiimote_tracker::continuous
