// What stays of the rig and of what was captured when something fails, is cancelled or is loaded.

#include "workflow_fixture.h"

namespace wiimote_tracker::workflow {
namespace {

TEST_F(Workflow, AFailedSolveKeepsCornersAndRig) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  const std::string id = calibration_.rig()->id();
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (const std::size_t c : {0, 1, 3, 2})
    ASSERT_TRUE(capture(kCorners[c]).success);
  const Reply crossing = solve(2.0);
  EXPECT_FALSE(crossing.success);
  EXPECT_SAYS(crossing.message, "out of order");
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  EXPECT_EQ(calibration_.rig()->id(), id);
}

TEST_F(Workflow, CancelStopsWhatGoesOnAndASecondOneDropsTheRun) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  ASSERT_TRUE(calibration_.start(1.0, 1.0, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  ASSERT_TRUE(calibration_.beginCapture(std::nullopt, now_).success);
  EXPECT_SAYS(calibration_.cancel().message, "corner 2 was not captured");
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_FALSE(calibration_.square().capture());
  EXPECT_EQ(calibration_.square().corners().size(), 1U);
  EXPECT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(calibration_.step(), Step::kIdle);
  EXPECT_TRUE(calibration_.rig());
  EXPECT_FALSE(calibration_.beginCapture(std::nullopt, now_).success);
}

TEST_F(Workflow, ACaptureThatFailsLeavesARigSolved) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  ASSERT_TRUE(calibration_.beginCapture(2, now_).success);
  EXPECT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(calibration_.step(), Step::kSolved);
  EXPECT_FALSE(calibration_.isUnsolved());
}

TEST_F(Workflow, AnAbandonedWaveKeepsWhatWasRecorded) {
  captureAll();
  const std::string before = calibration_.message();
  calibration_.abandonWave("time jumped back");
  EXPECT_EQ(calibration_.message(), before) << "there is none";
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(5.0);
  const std::size_t refusals = calibration_.refusals();
  calibration_.abandonWave("time jumped back");
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_EQ(calibration_.refusals(), refusals + 1);
  EXPECT_SAYS(calibration_.message(), "the wave was ended: time jumped back; recorded ");
  ASSERT_TRUE(calibration_.wave());
  EXPECT_GT(calibration_.wave()->report().seconds, 2.0);
}

TEST_F(Workflow, ACancelledWaveIsDroppedAndTheSquareStays) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(1.0);
  EXPECT_SAYS(calibration_.cancel().message, "the corners stay");
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_FALSE(calibration_.wave());
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
}

TEST_F(Workflow, ACancelAfterTheSolverEndedDropsNothing) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  EXPECT_SAYS(calibration_.cancel().message, "nothing was dropped");
  EXPECT_EQ(calibration_.step(), Step::kSolved);
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  // The same when it failed.
  ASSERT_TRUE(calibration_.begin(Step::kSolving, "solving").success);
  calibration_.end();
  EXPECT_SAYS(calibration_.cancel().message, "nothing was dropped");
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  EXPECT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(calibration_.step(), Step::kIdle);
  EXPECT_TRUE(calibration_.square().corners().empty());
  // Once something else was done it is the run that is meant.
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  calibration_.saved(*calibration_.rig());
  calibration_.cancel();
  EXPECT_EQ(calibration_.step(), Step::kIdle);
}

TEST_F(Workflow, ALoadedRigDoesNotDisturbARun) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  const geometry::Rig rig = *calibration_.rig();
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  EXPECT_TRUE(calibration_.load(rig).success);
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_EQ(calibration_.square().corners().size(), 1U);

  Calibration fresh{CalibrationOptions()};
  EXPECT_TRUE(fresh.load(rig).success);
  EXPECT_EQ(fresh.step(), Step::kSaved);
}

TEST_F(Workflow, ALoadedRigWithACameraTypedInMillimetresIsDoubted) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  geometry::Rig rig = *calibration_.rig();
  EXPECT_EQ(rig.describeFarCamera(), "");
  rig.cameras[1].camera.world_from_camera.translation() *= 1000.0;
  EXPECT_SAYS(calibration_.load(rig).message, "cameras is in use; but camera_2 is ");
}

TEST_F(Workflow, ARigThatIsSolvedAgainKeepsTheZones) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  geometry::Rig named = *calibration_.rig();
  EXPECT_TRUE(named.zones.empty());
  named.zones = {{"hall", {0.0, 0.0, 0.0}, {2.5, 2.5, 2.5}}};
  ASSERT_TRUE(calibration_.load(named).success);
  captureAll();
  const Reply reply = solve(2.0);
  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_NE(reply.message.find("zones"), std::string::npos) << reply.message;
  EXPECT_EQ(calibration_.rig()->solved_at, 2.0);
  ASSERT_EQ(calibration_.rig()->zones.size(), 1U);
  EXPECT_EQ(calibration_.rig()->zones[0].name, "hall");

  // Of another world they say nothing.
  named.world_frame = "garden";
  ASSERT_TRUE(calibration_.load(named).success);
  captureAll();
  ASSERT_TRUE(solve(3.0).success);
  EXPECT_TRUE(calibration_.rig()->zones.empty());
}

TEST_F(Workflow, MasksGoIntoTheRigAndVoidNoCorrection) {
  EXPECT_FALSE(calibration_.setMasks({{names_[0], {{{1.0, 2.0}, 3.0}}}})) << "no rig yet";
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  geometry::Rig corrected = *calibration_.rig();
  corrected.remap.emplace();
  corrected.remap->rig_id = corrected.id();
  calibration_.setRig(corrected, "");
  const capture::Masks masks = {{names_[1], {{{1.0, 2.0}, 3.0}}}};
  EXPECT_TRUE(calibration_.setMasks(masks));
  EXPECT_FALSE(calibration_.setMasks(masks)) << "nothing new";
  const geometry::Rig& rig = *calibration_.rig();
  EXPECT_EQ(rig.find(names_[1])->masks.size(), 1U);
  EXPECT_NE(rig.id(), corrected.id());
  EXPECT_EQ(rig.remap->rig_id, rig.id());
  EXPECT_TRUE(calibration_.setMasks({}));
  EXPECT_EQ(calibration_.rig()->id(), corrected.id());
}

TEST_F(Workflow, ASavedRigIsToBeSavedAgainOnceItsMasksChange) {
  captureAll();
  ASSERT_TRUE(solve(1.0).success);
  calibration_.saved(*calibration_.rig());
  ASSERT_EQ(calibration_.step(), Step::kSaved);
  ASSERT_TRUE(calibration_.setMasks({{names_[1], {{{1.0, 2.0}, 3.0}}}}));
  EXPECT_EQ(calibration_.step(), Step::kSolved);
  ASSERT_TRUE(calibration_.setMasks({}));
  EXPECT_EQ(calibration_.step(), Step::kSaved);
}

TEST_F(Workflow, CancelStopsALongTaskFirst) {
  captureAll();
  ASSERT_TRUE(calibration_.begin(Step::kSolving, "solving").success);
  EXPECT_EQ(calibration_.step(), Step::kSolving);
  EXPECT_SAYS(calibration_.undo().message, "the solver runs");
  EXPECT_SAYS(calibration_.begin(Step::kMasking, "").message, "the solver runs");
  EXPECT_THROW(calibration_.requireIdle(), Error);
  EXPECT_TRUE(calibration_.cancel().success);
  EXPECT_FALSE(calibration_.isBusyWith(Step::kSolving));
  // It takes its time to stop; nothing else begins meanwhile, and nothing is dropped.
  EXPECT_SAYS(calibration_.begin(Step::kMeasuring, "").message, "not stopped yet");
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "solving").message, "not stopped yet");
  EXPECT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  calibration_.end();
  EXPECT_NO_THROW(calibration_.requireIdle());
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  // So was this cancel, which came after the solver had stopped.
  EXPECT_SAYS(calibration_.cancel().message, "nothing was dropped");
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  ASSERT_TRUE(calibration_.begin(Step::kMeasuring, "measuring").success);
  EXPECT_TRUE(calibration_.isBusyWith(Step::kMeasuring));
  calibration_.setProgress(0.5);
  EXPECT_EQ(calibration_.progress(), 0.5);
  calibration_.end();
  EXPECT_EQ(calibration_.step(), Step::kComplete);
}

TEST_F(Workflow, SamplesThatAreRestoredAreTheSameSamples) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(2.0);
  calibration_.endWave();
  const capture::Masks masks = {{names_[1], {{{3.0, 4.0}, 5.0}}}};
  const samples::Samples samples = calibration_.samples(facts_, masks);
  CalibrationOptions other;
  other.layout.led_height = 0.5;  // what was captured has its own
  other.world_frame = "elsewhere";
  Calibration fresh{other};
  ASSERT_TRUE(fresh.restore(samples).success);
  EXPECT_TRUE(fresh.isRestored());
  EXPECT_EQ(fresh.step(), Step::kComplete);
  const samples::Samples again = fresh.samples({}, masks);
  EXPECT_EQ(again.world_frame, "world");
  EXPECT_EQ(again.recording.square->led_height, 0.0);
  ASSERT_EQ(again.recording.cameras.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const wave::CameraRecording& a = samples.recording.cameras[i];
    const wave::CameraRecording& b = again.recording.cameras[i];
    EXPECT_EQ(a.sightings.name, b.sightings.name);
    EXPECT_EQ(a.sightings.identity, b.sightings.identity);
    EXPECT_EQ(a.sightings.corners, b.sightings.corners);
    ASSERT_EQ(a.frames.size(), b.frames.size());
    for (std::size_t k = 0; k < a.frames.size(); ++k) {
      EXPECT_EQ(a.frames[k].stamp, b.frames[k].stamp);
      EXPECT_EQ(a.frames[k].spots, b.frames[k].spots);
    }
  }
  EXPECT_EQ(again.recording.cameras[1].masks.size(), 1U);
}

}  // namespace
}  // namespace wiimote_tracker::workflow
