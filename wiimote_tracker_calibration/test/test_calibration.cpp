// The workflow as a person goes through it, without ROS.

#include "wiimote_tracker_calibration/workflow/calibration.h"

#include "simulated_square.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::workflow {
namespace {

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

class Workflow : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto poses = square::paperRig();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      geometry::Camera camera;
      camera.name = "camera_" + std::to_string(i + 1);
      camera.world_from_camera = poses[i];
      cameras_.push_back(camera);
      names_.push_back(camera.name);
      facts_[camera.name].identity = "00:00:00:00:00:0" + std::to_string(i);
    }
  }

  /// Captures with the LED at a place that goes along with `speed` [m/s].
  Reply capture(const Eigen::Vector3d& led,
                std::optional<std::size_t> retake = std::nullopt,
                double speed = 0.0) {
    const Reply begun = calibration_.beginCapture(retake, now_);
    if (!begun.success)
      return begun;
    const double start = now_;
    for (; now_ < start + 20.0; now_ += 0.01) {
      const Eigen::Vector3d place = led + (now_ - start) * speed * Eigen::Vector3d::UnitX();
      for (const geometry::Camera& camera : cameras_)
        calibration_.addImage({camera.name, now_, 0, {camera.project(place).value()}, {}});
      calibration_.update(now_);
      if (calibration_.captureOutcome())
        return *calibration_.captureOutcome();
    }
    return {false, "never ended"};
  }

  void captureAll() {
    ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
    for (const Eigen::Vector3d& corner : kCorners)
      ASSERT_TRUE(capture(corner).success);
  }

  const std::vector<Eigen::Vector3d> kCorners = {{0.0, 0.0, 0.0},
                                                 {2.5, 0.0, 0.0},
                                                 {2.5, 2.5, 0.0},
                                                 {0.0, 2.5, 0.0}};
  std::vector<geometry::Camera> cameras_;
  std::vector<std::string> names_;
  std::map<std::string, CameraFacts> facts_;
  Calibration calibration_{CalibrationOptions()};
  double now_ = 100.0;
};

TEST_F(Workflow, four_corners_make_a_rig) {
  captureAll();
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_EQ(calibration_.progress(), 1.0);
  const Reply reply = calibration_.solve(facts_, 1234.5);
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
  calibration_.saved("saved");
  EXPECT_EQ(calibration_.step(), Step::kSaved);
}

TEST_F(Workflow, requests_out_of_turn_are_refused_with_a_reason) {
  EXPECT_SAYS(calibration_.beginCapture(std::nullopt, 0.0).message, "start one first");
  EXPECT_SAYS(calibration_.undo().message, "no captured corner");
  EXPECT_SAYS(calibration_.solve(facts_, 0.0).message, "only 0 of 4 corners");
  EXPECT_EQ(calibration_.step(), Step::kIdle);

  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(calibration_.beginCapture(std::nullopt, now_).success);
  EXPECT_EQ(calibration_.step(), Step::kCapturing);
  for (const Reply& reply :
       {calibration_.beginCapture(std::nullopt, now_), calibration_.start(1.0, 1.0, names_),
        calibration_.undo(), calibration_.solve(facts_, 0.0), calibration_.load(geometry::Rig())}) {
    EXPECT_FALSE(reply.success);
    EXPECT_SAYS(reply.message, "being captured");
  }
  EXPECT_EQ(calibration_.step(), Step::kCapturing);
  calibration_.abandonCapture("given up");
  EXPECT_EQ(calibration_.step(), Step::kReady);
}

TEST_F(Workflow, a_bad_start_keeps_the_run) {
  ASSERT_TRUE(calibration_.start(2.5, 2.0, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  EXPECT_SAYS(calibration_.start(0.0, 0.0, names_).message, "greater than 0");
  EXPECT_SAYS(calibration_.start(2.5, std::nan(""), names_).message, "greater than 0");
  EXPECT_SAYS(calibration_.start(2.5, 2.5, {"a", "a"}).message, "at least two cameras");
  EXPECT_EQ(calibration_.corners().size(), 1U);
  EXPECT_EQ(calibration_.sides(), std::vector<double>({2.5, 2.0}));
  ASSERT_TRUE(calibration_.start(1.0, 1.0, names_).success);
  EXPECT_EQ(calibration_.corners().size(), 0U);
}

TEST_F(Workflow, a_moved_led_loses_no_corner) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  const Reply moved = capture(kCorners[1], std::nullopt, 0.1);
  EXPECT_FALSE(moved.success);
  EXPECT_SAYS(moved.message, "corner 2 was not captured");
  EXPECT_EQ(calibration_.corners().size(), 1U);
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_TRUE(capture(kCorners[1]).success);
  EXPECT_EQ(calibration_.corners().size(), 2U);
}

TEST_F(Workflow, an_led_that_was_not_carried_on_is_refused) {
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  EXPECT_SAYS(capture(kCorners[0]).message, "still where corner 1");
  EXPECT_EQ(calibration_.corners().size(), 1U);
  EXPECT_TRUE(capture(kCorners[0], 0).success);  // retaking is another matter
}

TEST_F(Workflow, undo_drops_the_last_corner_and_retake_replaces_one) {
  captureAll();
  EXPECT_SAYS(capture(kCorners[0]).message, "all four corners are captured");
  ASSERT_TRUE(calibration_.undo().success);
  EXPECT_EQ(calibration_.corners().size(), 3U);
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_SAYS(capture(kCorners[3], 3).message, "cannot be taken again");
  ASSERT_TRUE(capture(kCorners[3]).success);

  const Eigen::Vector2d before = calibration_.corners()[1].at("camera_1").pixel;
  ASSERT_TRUE(capture(kCorners[1] + Eigen::Vector3d(0.0, 0.05, 0.0), 1).success);
  EXPECT_EQ(calibration_.corners().size(), 4U);
  EXPECT_GT((calibration_.corners()[1].at("camera_1").pixel - before).norm(), 1.0);
  EXPECT_EQ(calibration_.step(), Step::kComplete);

  const Eigen::Vector2d kept = calibration_.corners()[1].at("camera_1").pixel;
  EXPECT_FALSE(capture(kCorners[1], 1, 0.1).success);  // a failed retake changes nothing
  EXPECT_EQ(calibration_.corners()[1].at("camera_1").pixel, kept);
}

TEST_F(Workflow, a_failed_solve_keeps_corners_and_rig) {
  captureAll();
  ASSERT_TRUE(calibration_.solve(facts_, 1.0).success);
  const std::string id = calibration_.rig()->id();
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  for (const std::size_t c : {0, 1, 3, 2})
    ASSERT_TRUE(capture(kCorners[c]).success);
  const Reply crossing = calibration_.solve(facts_, 2.0);
  EXPECT_FALSE(crossing.success);
  EXPECT_SAYS(crossing.message, "out of order");
  EXPECT_EQ(calibration_.step(), Step::kComplete);
  EXPECT_EQ(calibration_.corners().size(), 4U);
  EXPECT_EQ(calibration_.rig()->id(), id);
}

TEST_F(Workflow, cancel_drops_the_run_and_keeps_the_rig) {
  captureAll();
  ASSERT_TRUE(calibration_.solve(facts_, 1.0).success);
  ASSERT_TRUE(calibration_.start(1.0, 1.0, names_).success);
  ASSERT_TRUE(calibration_.beginCapture(std::nullopt, now_).success);
  EXPECT_TRUE(calibration_.cancel().success);
  EXPECT_EQ(calibration_.step(), Step::kIdle);
  EXPECT_FALSE(calibration_.currentCapture());
  EXPECT_TRUE(calibration_.rig());
  EXPECT_FALSE(calibration_.beginCapture(std::nullopt, now_).success);
}

TEST_F(Workflow, a_loaded_rig_does_not_disturb_a_run) {
  captureAll();
  ASSERT_TRUE(calibration_.solve(facts_, 1.0).success);
  const geometry::Rig rig = *calibration_.rig();
  ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
  ASSERT_TRUE(capture(kCorners[0]).success);
  EXPECT_TRUE(calibration_.load(rig).success);
  EXPECT_EQ(calibration_.step(), Step::kReady);
  EXPECT_EQ(calibration_.corners().size(), 1U);

  Calibration fresh{CalibrationOptions()};
  EXPECT_TRUE(fresh.load(rig).success);
  EXPECT_EQ(fresh.step(), Step::kSaved);
}

}  // namespace
}  // namespace wiimote_tracker::workflow

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
