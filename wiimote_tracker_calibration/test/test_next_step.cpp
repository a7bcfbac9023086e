// What a person is told to do next, and hears.

#include "workflow/next_step.h"
#include "workflow/sounds.h"

#include "workflow_fixture.h"

namespace wiimote_tracker::workflow {
namespace {

class NextStepTest : public Workflow {
 protected:
  NextStep next() const { return nextStep(calibration_, verdict_, findings_); }
  samples::Verdict verdict_;
  Findings findings_;
  Sounds sounds_;
};

TEST_F(NextStepTest, MasksConnectionAndStartFollowEachOther) {
  EXPECT_EQ(next().request, "learn_masks");
  calibration_.preparation().lights_learned = true;
  EXPECT_EQ(next().request, "check_connection");
  calibration_.preparation().connection_checked = true;
  EXPECT_EQ(next().request, "start");
  ASSERT_TRUE(calibration_.begin(Step::kMasking, "").success);
  EXPECT_EQ(next().title, "LED off");
  EXPECT_TRUE(next().request.empty());
}

TEST_F(NextStepTest, ACheckedConnectionGoesOnWithoutMasks) {
  calibration_.preparation().connection_checked = true;
  EXPECT_EQ(next().request, "start");
}

TEST_F(NextStepTest, LightsOfARigFileAreLearned) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  ASSERT_TRUE(calibration_.load(rig).success);
  calibration_.cancel();
  EXPECT_EQ(next().request, "learn_masks");
  rig.cameras[0].masks = {{{1.0, 2.0}, 3.0}};
  ASSERT_TRUE(calibration_.load(rig).success);
  calibration_.cancel();
  EXPECT_EQ(next().request, "check_connection");
}

TEST_F(NextStepTest, ItLeadsOverCornersAndWaveToTheSolver) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    EXPECT_EQ(next().title, "Corner " + std::to_string(i + 1));
    EXPECT_EQ(next().request, "capture_corner");
    EXPECT_FALSE(next().corner);
    ASSERT_TRUE(capture(kCorners[i]).success);
    EXPECT_EQ(sounds_.heard(calibration_), "captured");
  }
  EXPECT_EQ(next().title, "Wave");
  EXPECT_EQ(next().request, "start_wave");
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  EXPECT_TRUE(next().request.empty());
  EXPECT_EQ(sounds_.heard(calibration_), "");
  wave(30.0);
  EXPECT_EQ(next().request, "stop_wave");
  EXPECT_EQ(sounds_.heard(calibration_), "enough");
  EXPECT_EQ(sounds_.heard(calibration_), "");
  ASSERT_TRUE(calibration_.endWave().success);
  EXPECT_EQ(next().request, "solve");
}

TEST_F(NextStepTest, TheVerdictDecidesWhatFollowsTheSolver) {
  captureAll();
  ASSERT_TRUE(calibration_.begin(Step::kSolving, "solving").success);
  EXPECT_EQ(next().title, "Solving");
  sounds_.heard(calibration_);
  calibration_.takeSolution(geometry::Rig());
  calibration_.end();
  EXPECT_EQ(sounds_.heard(calibration_), "solved");
  verdict_.grade = samples::Grade::kRedo;
  EXPECT_TRUE(next().request.empty());
  verdict_.redo_corner = 2;
  EXPECT_EQ(next().request, "capture_corner");
  EXPECT_EQ(next().corner, std::optional<std::size_t>(2));
  verdict_.grade = samples::Grade::kUsable;
  verdict_.doubts_scale = true;
  EXPECT_TRUE(next().request.empty());
  EXPECT_SAYS(next().sentence, "start again with them in metres, or save all the same");
  verdict_.doubts_scale = false;
  verdict_.grade = samples::Grade::kGood;
  EXPECT_EQ(next().request, "save");
  calibration_.saved(*calibration_.rig());
  EXPECT_EQ(next().title, "Ready");
  EXPECT_TRUE(next().request.empty());
  findings_.silent = "no image has come yet from wiimote_1: start its driver";
  EXPECT_EQ(next().title, "No images");
  EXPECT_EQ(next().sentence, "The rig is in use, but " + findings_.silent + ".");
}

TEST_F(NextStepTest, ARefusedCornerIsCapturedAgain) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (std::size_t c = 0; c < kCorners.size(); ++c)
    ASSERT_TRUE(capture(kCorners[c] + (c == 2 ? 0.3 : 0.0) * Eigen::Vector3d::UnitX()).success);
  EXPECT_SAYS(solve(1.0).message, "capture corner 3 again and solve");
  EXPECT_EQ(next().request, "capture_corner");
  EXPECT_EQ(next().title, "Corner 3");
  EXPECT_EQ(next().corner, std::optional<std::size_t>(2));
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  ASSERT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(next().request, "capture_corner") << "nothing was recorded";
  ASSERT_TRUE(capture(kCorners[2], 2).success);
  EXPECT_EQ(next().request, "start_wave");
  EXPECT_TRUE(solve(2.0).success);
}

TEST_F(NextStepTest, WhatCannotBeSolvedIsNotWavedOn) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (const std::size_t c : {0, 1, 3, 2})
    ASSERT_TRUE(capture(kCorners[c]).success);
  EXPECT_SAYS(solve(1.0).message, "out of order");
  EXPECT_EQ(next().title, "Again");
  EXPECT_TRUE(next().request.empty());
  ASSERT_TRUE(calibration_.undo().success);
  EXPECT_EQ(next().title, "Corner 4");
  ASSERT_TRUE(capture(kCorners[2]).success);
  EXPECT_EQ(next().title, "Wave") << "something was captured since";
}

TEST_F(NextStepTest, ACameraThatWasMovedIsToBeCorrected) {
  geometry::Rig rig;
  rig.cameras.resize(3);
  for (geometry::RigCamera& camera : rig.cameras)
    camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  ASSERT_TRUE(calibration_.load(rig).success);
  EXPECT_EQ(next().title, "Ready");
  findings_.changed = {"wiimote_2"};
  findings_.remedy = "put it back";
  EXPECT_EQ(next().title, "Check wiimote_2");
  EXPECT_EQ(next().sentence, "wiimote_2 no longer fits the calibration: put it back.");
  EXPECT_TRUE(next().request.empty());
  findings_.correctable = {"wiimote_2"};
  findings_.cause = continuous::Cause::kKnock;
  EXPECT_EQ(next().title, "Correct wiimote_2");
  EXPECT_EQ(next().request, "continuous/apply");
  EXPECT_EQ(next().label, "correct it");
  findings_.correctable = {"wiimote_2", "wiimote_3"};
  EXPECT_EQ(next().title, "Correct cameras");
  EXPECT_EQ(next().sentence, "wiimote_2, wiimote_3 were moved. Their new poses are known.");
}

TEST_F(NextStepTest, DriftAndClocksAreNotCalledMoved) {
  ASSERT_TRUE(calibration_.load(geometry::Rig()).success);
  findings_.correctable = {"wiimote_2"};
  findings_.cause = continuous::Cause::kDrift;
  EXPECT_EQ(next().title, "Correct drift");
  EXPECT_SAYS(next().sentence, "have drifted since they were calibrated, most of all wiimote_2");
  findings_.cause = continuous::Cause::kReconnect;
  EXPECT_EQ(next().title, "Correct clocks");
  EXPECT_SAYS(next().sentence, "other clocks since they reconnected, most of all wiimote_2");
  EXPECT_EQ(next().request, "continuous/apply");
}

TEST_F(NextStepTest, ACameraThatWasMovedIsNextAlsoAfterACancel) {
  ASSERT_TRUE(calibration_.load(geometry::Rig()).success);
  calibration_.cancel();
  ASSERT_EQ(calibration_.step(), Step::kIdle);
  EXPECT_EQ(next().request, "learn_masks");
  findings_.changed = {"wiimote_2"};
  EXPECT_EQ(next().title, "Check wiimote_2");
  findings_.correctable = {"wiimote_2"};
  EXPECT_EQ(next().title, "Correct wiimote_2");
}

TEST_F(NextStepTest, ARigOnTheWayIsWaitedForAndSavedAsItWillBe) {
  verdict_.grade = samples::Grade::kGood;
  geometry::Rig rig;
  rig.cameras.resize(1);
  ASSERT_TRUE(calibration_.load(rig).success);
  geometry::Rig goal = rig;
  goal.cameras[0].time_offset = 0.002;
  geometry::Rig step = rig;
  step.cameras[0].time_offset = 0.001;
  calibration_.setGoal(goal);
  EXPECT_EQ(next().title, "Wait");
  calibration_.setRig(step, "a step");
  calibration_.setGoal(goal);
  findings_.changed = {"wiimote_2"};
  EXPECT_EQ(next().title, "Wait") << "what is corrected is still found";
  EXPECT_TRUE(next().request.empty());
  findings_.changed.clear();
  calibration_.setRig(goal, "reached");
  EXPECT_FALSE(calibration_.goal());
  EXPECT_EQ(next().request, "save");

  calibration_.setRig(step, "a step");
  calibration_.setGoal(goal);
  calibration_.saved(goal);
  EXPECT_EQ(calibration_.step(), Step::kSolved) << "no file has the step in use";
  calibration_.setRig(goal, "reached");
  EXPECT_EQ(calibration_.step(), Step::kSaved);
  goal.remap.emplace();
  calibration_.setRig(goal, "a correction of the volume");
  EXPECT_EQ(calibration_.step(), Step::kSolved);
}

TEST_F(NextStepTest, ACorrectionIsBeforeTheSavingButAfterABadCorner) {
  captureAll();
  ASSERT_TRUE(calibration_.begin(Step::kSolving, "solving").success);
  calibration_.takeSolution(geometry::Rig());
  calibration_.end();
  findings_.changed = {"wiimote_2"};
  verdict_.grade = samples::Grade::kGood;
  EXPECT_EQ(next().title, "Check wiimote_2");
  findings_.correctable = {"wiimote_2"};
  EXPECT_EQ(next().request, "continuous/apply");
  verdict_.grade = samples::Grade::kRedo;
  verdict_.redo_corner = 2;
  EXPECT_EQ(next().request, "capture_corner");
}

TEST_F(NextStepTest, AMeasuredPlaceNeedsAStillLedAndARecalibratedCameraAWavedOne) {
  ASSERT_TRUE(calibration_.begin(Step::kMeasuring, "").success);
  EXPECT_EQ(next().title, "Hold still");
  calibration_.end();
  ASSERT_TRUE(calibration_.begin(Step::kMeasuring, "", true).success);
  EXPECT_EQ(next().title, "Wave");
  EXPECT_TRUE(next().request.empty());
}

TEST_F(NextStepTest, CornersThatGoClockwiseAreQuestioned) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (const std::size_t corner : {0U, 3U, 2U, 1U})
    ASSERT_TRUE(capture(kCorners[corner]).success);
  EXPECT_EQ(next().title, "z is down");
  EXPECT_EQ(next().request, "start_wave");
}

TEST_F(NextStepTest, HandsFreeAndWandNeedNoCapture) {
  calibration_.setHandsFree(true);
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  EXPECT_TRUE(next().request.empty());
  ASSERT_TRUE(calibration_.startWithoutSquare(names_).success);
  EXPECT_EQ(next().title, "Wand");
  wave::Wand wand;
  wand.length = 0.5;
  ASSERT_TRUE(calibration_.beginWave(cameras_, false, wand, now_).success);
  ASSERT_TRUE(calibration_.endWave().success);
  EXPECT_EQ(next().title, "Wand") << "nothing moved, and there is no square to solve";
}

TEST_F(NextStepTest, AnotherWaveMayBeSolvedThoughTheLastOneWasRefused) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(3.0);
  ASSERT_TRUE(calibration_.endWave().success);
  calibration_.refuseSolution({});
  EXPECT_EQ(next().title, "Again");
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  ASSERT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(next().title, "Wave") << "that wave was dropped";
}

TEST_F(NextStepTest, AWandOnTheFloorIsCapturedWavedAndSolved) {
  wave::Wand wand;
  wand.length = 0.5;
  wand.led_height = 0.0;
  ASSERT_TRUE(calibration_.startWithoutSquare(names_).success);
  ASSERT_TRUE(calibration_.beginWave(cameras_, false, wand, now_).success);
  EXPECT_EQ(next().title, "Leave it");
  EXPECT_SAYS(next().sentence, "nearer to camera_1");
  waveWand(1.5, false);
  EXPECT_EQ(next().title, "Leave it");
  EXPECT_SAYS(calibration_.missing().front(), "leave it on the floor");
  EXPECT_EQ(sounds_.heard(calibration_), "");
  waveWand(1.0, false);
  EXPECT_EQ(next().title, "Wave");
  EXPECT_EQ(sounds_.heard(calibration_), "captured");
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "solving").message, "a wave is being recorded");
  waveWand(30.0, true);
  EXPECT_EQ(next().request, "solve");
  const samples::Samples samples = calibration_.samples(facts_, {});
  EXPECT_EQ(samples.recording.wand->led_height, 0.0);
  EXPECT_TRUE(calibration_.begin(Step::kSolving, "solving").success);
  EXPECT_EQ(calibration_.step(), Step::kSolving);
  calibration_.end();
  Calibration fresh{CalibrationOptions()};
  ASSERT_TRUE(fresh.restore(samples).success);
  EXPECT_TRUE(fresh.missing().empty());
}

TEST_F(NextStepTest, SidesThatAreHardlyMeantAreQuestioned) {
  for (const double side : {0.25, 12.0}) {
    ASSERT_TRUE(calibration_.start(side, 2.5, names_).success);
    EXPECT_SAYS(next().sentence, "if that is wrong, start again");
  }
  ASSERT_TRUE(calibration_.start(0.3, 10.0, names_).success);
  EXPECT_EQ(next().sentence.find("wrong"), std::string::npos);
}

TEST_F(NextStepTest, ACornerTakenAgainIsHeard) {
  captureAll();
  EXPECT_EQ(sounds_.heard(calibration_), "captured");
  ASSERT_TRUE(capture(kCorners[1], 1).success);
  EXPECT_EQ(sounds_.heard(calibration_), "captured");
}

TEST_F(NextStepTest, ARefusalIsHeard) {
  EXPECT_EQ(sounds_.heard(calibration_), "");
  EXPECT_FALSE(calibration_.shown(calibration_.endWave()).success);
  EXPECT_SAYS(calibration_.message(), "no wave is being recorded");
  EXPECT_EQ(sounds_.heard(calibration_), "refused");
  EXPECT_EQ(sounds_.heard(calibration_), "");
}

}  // namespace
}  // namespace wiimote_tracker::workflow
