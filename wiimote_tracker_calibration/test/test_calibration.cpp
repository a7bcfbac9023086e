// The workflow as a person goes through it, without ROS.

#include "workflow_fixture.h"

namespace wiimote_tracker::workflow {
namespace {

TEST_F(Workflow, FourCornersMakeARig) {
  captureAll();
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_EQ(calibration_.progress(), 1.0);
  const Reply reply = solve(1234.5);
  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(calibration_.step(), Step::kSolved);
  ASSERT_TRUE(calibration_.rig());
  const geometry::Rig& rig = *calibration_.rig();
  EXPECT_EQ(reply.message, rig.verdict);
  EXPECT_EQ(rig.solved_at, 1234.5);
  EXPECT_EQ(rig.world_frame, "world");
  EXPECT_EQ(rig.square_sides, std::vector<double>({2.5, 2.5}));
  ASSERT_EQ(rig.cameras.size(), 4U);
  EXPECT_EQ(rig.cameras[2].camera.identity, "00:00:00:00:00:02");
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((rig.cameras[i].camera.center() - cameras_[i].center()).norm(), 1e-6);
  calibration_.saved(*calibration_.rig());
  EXPECT_EQ(calibration_.step(), Step::kSaved);
}

TEST_F(Workflow, ClockwiseCornersAreReported) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (const std::size_t corner : {0U, 3U, 2U})
    ASSERT_TRUE(capture(kCorners[corner]).success);
  EXPECT_SAYS(capture(kCorners[1]).message, "clockwise seen from above, so that z will point down");
}

TEST_F(Workflow, RequestsInTheWrongStepAreRefusedWithAReason) {
  EXPECT_SAYS(calibration_.beginCapture(std::nullopt, 0.0).message, "start one first");
  EXPECT_SAYS(calibration_.undo().message, "no captured corner");
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "solving").message, "no calibration is started");
  EXPECT_EQ(calibration_.step(), Step::kIdle);

  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(calibration_.beginCapture(std::nullopt, now_).success);
  EXPECT_EQ(calibration_.step(), Step::kCapturing);
  for (const Reply& reply :
       {calibration_.beginCapture(std::nullopt, now_), calibration_.start(1.0, 1.0, names_),
        calibration_.undo(), calibration_.begin(Step::kSolving, "solving"),
        calibration_.load(geometry::Rig())}) {
    EXPECT_FALSE(reply.success);
    EXPECT_SAYS(reply.message, "being captured");
  }
  EXPECT_EQ(calibration_.step(), Step::kCapturing);
  calibration_.abandonCapture("given up");
  EXPECT_EQ(calibration_.step(), Step::kReady);
}

TEST_F(Workflow, CamerasThatWouldShareAFileAreRefusedBeforeAnythingIsCaptured) {
  const Reply reply = calibration_.start(2.5, 2.5, {"a/b", "a_b", "camera_1"});
  EXPECT_FALSE(reply.success);
  EXPECT_SAYS(reply.message, "'a/b' and 'a_b', share the frame");
  EXPECT_EQ(calibration_.step(), Step::kIdle);
  EXPECT_FALSE(calibration_.startWithoutSquare({"a/b", "a_b"}).success);
}

TEST_F(Workflow, AnExchangedDeviceIsNamed) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, false, std::nullopt, now_).success);
  for (const char* device : {"00:00:00:00:00:01", "00:00:00:00:00:07"})
    calibration_.addImage({names_[1], now_ += 0.01, 0, {{500.0, 400.0}}, {}, device});
  ASSERT_TRUE(calibration_.endWave().success);
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "").message,
              "camera_2 was first the device 00:00:00:00:00:01, then 00:00:00:00:00:07");
}

TEST_F(Workflow, ADeviceOfWhichNothingIsKeptMayBeExchanged) {
  const auto show = [this](const std::string& camera, const char* device) {
    calibration_.addImage({camera, now_ += 0.01, 0, {{500.0, 400.0}}, {}, device});
  };
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(calibration_.beginCapture(std::nullopt, now_).success);
  show(names_[1], "00:00:00:00:00:01");
  calibration_.abandonCapture("it failed");
  for (const Eigen::Vector3d& corner : kCorners)
    ASSERT_TRUE(capture(corner).success);
  ASSERT_TRUE(calibration_.beginWave(cameras_, false, std::nullopt, now_).success);
  show(names_[1], "00:00:00:00:00:07");
  show("not of this run", "00:00:00:00:00:02");
  show("not of this run", "00:00:00:00:00:03");
  ASSERT_TRUE(calibration_.endWave().success);
  EXPECT_TRUE(calibration_.begin(Step::kSolving, "").success);
}

TEST_F(Workflow, AnExchangedDeviceOfRestoredSamplesIsNamed) {
  captureAll();
  Calibration restored{CalibrationOptions()};
  ASSERT_TRUE(restored.restore(calibration_.samples(facts_, {})).success);
  ASSERT_TRUE(restored.beginWave(cameras_, false, std::nullopt, now_).success);
  restored.addImage({names_[1], now_ += 0.01, 0, {{500.0, 400.0}}, {}, "00:00:00:00:00:07"});
  ASSERT_TRUE(restored.endWave().success);
  EXPECT_SAYS(restored.begin(Step::kSolving, "").message,
              "camera_2 was first the device 00:00:00:00:00:01, then 00:00:00:00:00:07");
}

TEST_F(Workflow, TheDataAreOfTheDeviceThatTookThem) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, false, std::nullopt, now_).success);
  calibration_.addImage({names_[1], now_ += 0.01, 0, {{500.0, 400.0}}, {}, "00:00:00:00:00:01"});
  facts_[names_[1]].identity = "00:00:00:00:00:07";  // connected later
  const samples::Samples samples = calibration_.samples(facts_, {});
  EXPECT_EQ(samples.recording.cameras[1].sightings.identity, "00:00:00:00:00:01");
}

TEST_F(Workflow, ABadStartKeepsTheRun) {
  EXPECT_SAYS(calibration_.start(2.5, 2.0, names_).message, "and a square of 2.5 m x 2 m");
  ASSERT_TRUE(capture(kCorners[0]).success);
  EXPECT_SAYS(calibration_.start(0.0, 0.0, names_).message, "greater than 0");
  EXPECT_SAYS(calibration_.start(2.5, std::nan(""), names_).message, "greater than 0");
  EXPECT_SAYS(calibration_.start(250.0, 250.0, names_).message, "in metres");
  EXPECT_SAYS(calibration_.start(2.5, 2.5, {"a", "a"}).message, "at least two cameras");
  EXPECT_SAYS(calibration_.start(2.5, 2.5, {"a", "a"}).message,
              "only a: connect another one, and name at least two, or none for all");
  EXPECT_SAYS(calibration_.start(2.5, 2.5, {}).message, "there is none: connect");
  EXPECT_EQ(calibration_.square().corners().size(), 1U);
  EXPECT_EQ(calibration_.layout().value().side_y, 2.0);
  ASSERT_TRUE(calibration_.start(1.0, 1.0, names_).success);
  EXPECT_EQ(calibration_.square().corners().size(), 0U);
}

TEST_F(Workflow, AMovedLedLosesNoCorner) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  const Reply moved = capture(kCorners[1], std::nullopt, 0.1);
  EXPECT_FALSE(moved.success);
  EXPECT_SAYS(moved.message, "corner 2 was not captured");
  EXPECT_EQ(calibration_.square().corners().size(), 1U);
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_TRUE(capture(kCorners[1]).success);
  EXPECT_EQ(calibration_.square().corners().size(), 2U);
}

TEST_F(Workflow, AnLedStillOnTheLastCornerIsRefused) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  EXPECT_SAYS(capture(kCorners[0]).message, "still where corner 1");
  EXPECT_EQ(calibration_.square().corners().size(), 1U);
  EXPECT_TRUE(capture(kCorners[0], 0).success);  // retaking is another matter
}

TEST_F(Workflow, UndoDropsTheLastCornerAndRetakeReplacesOne) {
  captureAll();
  EXPECT_SAYS(capture(kCorners[0]).message, "all four corners are captured");
  ASSERT_TRUE(calibration_.undo().success);
  EXPECT_EQ(calibration_.square().corners().size(), 3U);
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_SAYS(capture(kCorners[3], 3).message, "cannot be captured again");
  ASSERT_TRUE(capture(kCorners[3]).success);

  const Eigen::Vector2d before = calibration_.square().corners()[1].at("camera_1").pixel;
  ASSERT_TRUE(capture(kCorners[1] + Eigen::Vector3d(0.0, 0.05, 0.0), 1).success);
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  EXPECT_GT((calibration_.square().corners()[1].at("camera_1").pixel - before).norm(), 1.0);
  EXPECT_EQ(calibration_.step(), Step::kComplete);

  const Eigen::Vector2d kept = calibration_.square().corners()[1].at("camera_1").pixel;
  EXPECT_FALSE(capture(kCorners[1], 1, 0.1).success);  // a failed retake changes nothing
  EXPECT_EQ(calibration_.square().corners()[1].at("camera_1").pixel, kept);
}

TEST_F(Workflow, LengthsAreTakenReplacedAndDropped) {
  constexpr double kPlacement = 0.005;
  const double diagonal = 2.5 * M_SQRT2;
  const auto measure = [&](std::size_t from, std::size_t to, double length) {
    return calibration_.measureLength({from, to, length, 0.001}, kPlacement);
  };
  const auto lengths = [&] { return calibration_.samples(facts_, {}).recording.square->lengths; };
  EXPECT_SAYS(measure(0, 2, diagonal).message, "start one first");
  ASSERT_TRUE(calibration_.startWithoutSquare(names_).success);
  EXPECT_SAYS(measure(0, 2, diagonal).message, "no square to measure");
  captureAll();
  ASSERT_TRUE(solve(1.0).success);

  EXPECT_SAYS(measure(0, 0, diagonal).message, "between two captured corners");
  EXPECT_SAYS(measure(0, 4, diagonal).message,
              "corners, of which there are 4, and not from 1 to 5 (in the service from 0 on): "
              "capture both");
  EXPECT_SAYS(measure(0, 2, -diagonal).message, "must be above 0");
  EXPECT_SAYS(measure(0, 2, std::nan("")).message, "must be above 0");
  EXPECT_SAYS(measure(0, 2, 3.2).message,
              "corner 1 to corner 3 is 3.536 m by the sides, at most 71 mm more or less, but the "
              "tape says 3.200 m");
  EXPECT_SAYS(measure(0, 2, 0.0).message, "there is no length");
  EXPECT_EQ(calibration_.step(), Step::kSolved);
  const Reply taken = measure(0, 2, diagonal + 0.004);
  EXPECT_TRUE(taken.success);
  EXPECT_SAYS(taken.message,
              "corner 1 to corner 3 is 3.5395 m by tape, 4.0 mm more than by the sides");
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  ASSERT_TRUE(solve(2.0).success);

  EXPECT_SAYS(measure(2, 0, diagonal - 1e-5).message, "by tape, 0.0 mm less than by the sides");
  EXPECT_TRUE(measure(2, 0, diagonal).success);
  ASSERT_EQ(lengths().size(), 1U);
  EXPECT_EQ(lengths()[0].length, diagonal);
  EXPECT_TRUE(measure(1, 2, 2.5).success);
  EXPECT_TRUE(measure(0, 2, 0.0).success);
  ASSERT_EQ(lengths().size(), 1U);
  EXPECT_TRUE(measure(0, 3, 2.5).success);
  EXPECT_FALSE(capture(kCorners[1], 1, 0.1).success);
  EXPECT_EQ(lengths().size(), 2U);
  ASSERT_TRUE(capture(kCorners[1], 1).success);  // it lies elsewhere now
  ASSERT_EQ(lengths().size(), 1U);
  EXPECT_EQ(lengths()[0].to, 3U);
  ASSERT_TRUE(calibration_.undo().success);
  EXPECT_TRUE(lengths().empty());
}

TEST_F(Workflow, UndoDropsALengthThatWasTakenLast) {
  captureAll();
  const auto measure = [&](std::size_t to, double length = 2.5) {
    return calibration_.measureLength({0, to, length, 0.001}, 0.005).success;
  };
  const auto begin = [&] {
    return calibration_.beginWave(cameras_, false, std::nullopt, now_).success;
  };
  const auto record = [&] { return begin() && calibration_.endWave().success; };
  ASSERT_TRUE(measure(1) && record() && measure(3));
  EXPECT_SAYS(calibration_.undo().message, "the length from corner 1 to corner 4 was dropped");
  EXPECT_SAYS(calibration_.undo().message, "the wave was dropped") << "taken after the other";
  ASSERT_TRUE(record() && measure(3) && measure(3, 0.0));
  EXPECT_SAYS(calibration_.undo().message, "the wave was dropped");
  ASSERT_TRUE(measure(3) && record() && measure(1));
  EXPECT_SAYS(calibration_.undo().message, "the length from corner 1 to corner 2 was dropped");
  EXPECT_SAYS(calibration_.undo().message, "the wave was dropped");
  ASSERT_TRUE(measure(1) && begin() && calibration_.cancel().success);
  EXPECT_SAYS(calibration_.undo().message, "the length from corner 1 to corner 2 was dropped");
}

TEST_F(Workflow, KnownPlacesAreTakenSolvedAndDropped) {
  const square::KnownPlace known{{0.0, 2.5, 2.0}, 0.001};
  capture::CapturedCorner seen;
  for (const geometry::Camera& camera : cameras_)
    seen[camera.name] = {*camera.project(known.position), 0.1, 20};
  EXPECT_SAYS(calibration_.addPlace(known, seen).message, "capture its four corners first");
  captureAll();
  EXPECT_SAYS(calibration_.whyNoPlace(), "solve first");
  ASSERT_TRUE(solve(1.0).success);
  EXPECT_EQ(calibration_.whyNoPlace(), "");
  const Reply taken = calibration_.addPlace(known, seen);
  EXPECT_TRUE(taken.success);
  EXPECT_SAYS(taken.message, "place 1 at (0.000, 2.500, 2.000) m is captured by 4 cameras");
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  ASSERT_TRUE(solve(2.0).success);
  const samples::Samples samples = calibration_.samples(facts_, {});
  EXPECT_EQ(samples.recording.square->places.size(), 1U);
  ASSERT_EQ(samples.recording.cameras[2].sightings.places.size(), 1U);
  ASSERT_TRUE(calibration_.setMasks({{"camera_1", {{Eigen::Vector2d(100.0, 200.0), 12.0}}}}));
  EXPECT_TRUE(calibration_.addPlace(known, seen).success);
  geometry::Rig rig = *calibration_.rig();
  rig.cameras[1].camera.world_from_camera.translation().x() += 0.1;
  calibration_.setRig(rig, "camera_2 is calibrated again");
  EXPECT_SAYS(calibration_.addPlace(known, seen).message, "a camera was changed");
  ASSERT_TRUE(calibration_.restore(samples).success);
  EXPECT_EQ(*calibration_.samples(facts_, {}).recording.cameras[2].sightings.places[0],
            seen.at("camera_3").pixel);
  EXPECT_SAYS(calibration_.undo().message, "the last known place was dropped");
  EXPECT_TRUE(calibration_.samples(facts_, {}).recording.cameras[0].sightings.places.empty());
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
}

TEST_F(Workflow, AWaveIsRecordedCoveredAndKeptBesideTheSquare) {
  EXPECT_SAYS(calibration_.beginWave(cameras_, true, std::nullopt, now_).message,
              "start one first");
  EXPECT_SAYS(calibration_.endWave().message, "no wave is being recorded");
  captureAll();
  EXPECT_TRUE(calibration_.missing().empty());
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  EXPECT_EQ(calibration_.step(), Step::kWaving);
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "solving").message, "a wave is being recorded");
  wave(5.0);
  EXPECT_FALSE(calibration_.missing().empty());
  EXPECT_GT(calibration_.progress(), 0.2);
  EXPECT_LT(calibration_.progress(), 0.5);
  wave(13.0);
  EXPECT_TRUE(calibration_.missing().empty()) << calibration_.missing().front();
  const Reply reply = calibration_.endWave();
  EXPECT_TRUE(reply.success);
  EXPECT_SAYS(reply.message, "enough: solve");
  const samples::Samples samples = calibration_.samples(facts_, {});
  EXPECT_NEAR(static_cast<double>(samples.recording.cameras[2].frames.size()), 1800.0, 2.0);
  wave(1.0);  // after the end
  EXPECT_EQ(calibration_.samples(facts_, {}).recording.cameras[2].frames.size(),
            samples.recording.cameras[2].frames.size());
  EXPECT_TRUE(calibration_.undo().success);
  EXPECT_FALSE(calibration_.wave());
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
}

TEST_F(Workflow, ARefusedSolveDoesNotEndTheWave) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(30.0);
  ASSERT_TRUE(calibration_.missing().empty()) << calibration_.missing().front();
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "solving").message, "only 0 of 4 corners");
  EXPECT_EQ(calibration_.step(), Step::kWaving);
}

TEST_F(Workflow, FramesOfAnOlderClockEpochAreDroppedAndReported) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(3.0, 6);
  wave(2.0, 7);
  const samples::Samples samples = calibration_.samples(facts_, {});
  EXPECT_EQ(samples.recording.cameras[0].clock_epoch, 7U);
  EXPECT_NEAR(static_cast<double>(samples.recording.cameras[0].frames.size()), 200.0, 2.0);
  EXPECT_NEAR(static_cast<double>(samples.recording.cameras[1].frames.size()), 500.0, 2.0);
  EXPECT_SAYS(calibration_.missing().back(), names_[0] + " reconnected");
}

TEST_F(Workflow, ACameraThatReconnectsLeavesTheVolumeOfTheOthers) {
  captureAll();
  ASSERT_TRUE(calibration_.beginWave(cameras_, true, std::nullopt, now_).success);
  wave(10.0, 6);
  const double before = *calibration_.wave()->report().volume;
  wave(0.05, 7);
  EXPECT_GT(*calibration_.wave()->report().volume, 0.8 * before);
}

TEST_F(Workflow, WithoutASquareItTakesAWand) {
  ASSERT_TRUE(calibration_.startWithoutSquare(names_).success);
  EXPECT_FALSE(calibration_.layout());
  EXPECT_SAYS(calibration_.beginCapture(std::nullopt, now_).message, "without a square");
  EXPECT_SAYS(calibration_.begin(Step::kSolving, "solving").message, "no wand was waved");
  EXPECT_SAYS(calibration_.beginWave(cameras_, false, std::nullopt, now_).message, "no scale");
  wave::Wand wand;
  wand.length = -0.5;
  EXPECT_FALSE(calibration_.beginWave(cameras_, false, wand, now_).success);
  wand.length = 0.5;
  ASSERT_TRUE(calibration_.beginWave(cameras_, false, wand, now_).success);
  calibration_.endWave();
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_FALSE(calibration_.samples(facts_, {}).recording.square);
  EXPECT_EQ(calibration_.samples(facts_, {}).recording.wand->length, 0.5);
}

TEST_F(Workflow, CornersAreCapturedHandsFree) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  calibration_.setHandsFree(true);
  EXPECT_TRUE(calibration_.isHandsFree());
  Eigen::Vector3d before = kCorners[0];
  for (const Eigen::Vector3d& corner : kCorners) {
    for (int i = 0; i < 600; ++i, now_ += 0.01) {  // carried for 2 s, then let lie
      const Eigen::Vector3d led = before + std::min(1.0, i / 200.0) * (corner - before);
      for (const geometry::Camera& camera : cameras_)
        calibration_.addImage({camera.name, now_, 0, {camera.project(led).value()}, {}});
    }
    before = corner;
  }
  EXPECT_EQ(calibration_.square().corners().size(), 4U);
  EXPECT_TRUE(solve(1.0).success);
}

}  // namespace
}  // namespace wiimote_tracker::workflow
