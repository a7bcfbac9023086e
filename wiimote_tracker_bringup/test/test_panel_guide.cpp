// What the Tracker panel asks for next, from the calibration node's messages.

#include "guide.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace wiimote_tracker::panel {
namespace {

using wiimote_tracker_msgs::CalibrationStatus;
using wiimote_tracker_msgs::CalibrationVerdict;

class NextStep : public testing::Test {
 protected:
  Advice at(std::uint8_t step) {
    status_.step = step;
    status_.corners_needed = 4;
    guide_.onStatus(status_, now_);
    return guide_.advice(now_);
  }
  void answered(Command command, bool good = true) {
    guide_.onRequest(command);
    guide_.onAnswer(command, good, good ? "done" : "refused: the LED is hidden");
  }
  /// All four corners as one camera saw them.
  void capture(const std::array<std::array<double, 2>, 4>& pixels) {
    for (const auto& pixel : pixels) {
      status_.cameras.resize(1);
      status_.cameras[0].name = "a";
      status_.cameras[0].sees_led = 1;
      status_.cameras[0].x = pixel[0];
      status_.cameras[0].y = pixel[1];
      ++status_.corners_captured;
      at(CalibrationStatus::READY);
    }
  }
  void judge(std::uint8_t grade, int redo_corner = -1) {
    status_.rig_id = "rig";
    CalibrationVerdict verdict;
    verdict.rig_id = "rig";
    verdict.grade = grade;
    verdict.redo_corner = redo_corner;
    guide_.onVerdict(verdict);
  }

  Guide guide_;
  CalibrationStatus status_;
  double now_ = 100.0;
};

TEST_F(NextStep, WithoutANodeItSaysHowToStartIt) {
  EXPECT_EQ(guide_.advice(now_).title, "No node");
  at(CalibrationStatus::IDLE);
  now_ += 4.0;
  EXPECT_EQ(guide_.advice(now_).title, "No node");
  EXPECT_TRUE(guide_.advice(now_).button.empty());
}

TEST_F(NextStep, MasksConnectionAndStartFollowEachOther) {
  EXPECT_EQ(at(CalibrationStatus::IDLE).request.command, Command::kMasks);
  answered(Command::kMasks, false);  // a step that was refused is asked for again
  EXPECT_EQ(at(CalibrationStatus::IDLE).request.command, Command::kMasks);
  answered(Command::kMasks);
  EXPECT_EQ(at(CalibrationStatus::IDLE).request.command, Command::kConnection);
  answered(Command::kConnection);
  EXPECT_EQ(at(CalibrationStatus::IDLE).request.command, Command::kStart);
}

TEST_F(NextStep, NothingCanBePressedUntilAnAnswerAndItsEffectAreKnown) {
  at(CalibrationStatus::IDLE);
  EXPECT_FALSE(guide_.isWaiting());
  guide_.onRequest(Command::kMasks);
  EXPECT_TRUE(guide_.isWaiting());
  guide_.onAnswer(Command::kMasks, true, "done");
  EXPECT_TRUE(guide_.isWaiting());
  at(CalibrationStatus::IDLE);
  EXPECT_FALSE(guide_.isWaiting());
}

TEST_F(NextStep, ARefusalStaysUntilTheNodeSaysSomethingNew) {
  status_.message = "ready";
  at(CalibrationStatus::READY);
  answered(Command::kCapture, false);
  at(CalibrationStatus::READY);
  EXPECT_EQ(guide_.answer(), "refused: the LED is hidden");
  status_.message = "corner 1 captured";
  at(CalibrationStatus::READY);
  EXPECT_EQ(guide_.answer(), "corner 1 captured");
}

TEST_F(NextStep, NamesTheCornerAndNeedsNoButtonWhenHandsAreFree) {
  status_.corners_captured = 2;
  EXPECT_EQ(at(CalibrationStatus::READY).title, "Corner 3");
  EXPECT_EQ(guide_.advice(now_).request.command, Command::kCapture);
  status_.hands_free = 1;
  EXPECT_TRUE(at(CalibrationStatus::READY).button.empty());
}

TEST_F(NextStep, AWaveEndsWhenNothingIsMissing) {
  status_.missing = {"wave higher"};
  EXPECT_TRUE(at(CalibrationStatus::WAVING).button.empty());
  EXPECT_EQ(guide_.remarks(), status_.missing);
  status_.missing.clear();
  EXPECT_EQ(at(CalibrationStatus::WAVING).request.command, Command::kStopWave);
}

TEST_F(NextStep, AfterARefusedWaveTheSquareAloneIsSolved) {
  EXPECT_EQ(at(CalibrationStatus::COMPLETE).request.command, Command::kStartWave);
  answered(Command::kStartWave, false);
  EXPECT_EQ(at(CalibrationStatus::COMPLETE).request.command, Command::kSolve);
}

TEST_F(NextStep, CornersThatGoClockwiseInTheImageAreQuestioned) {
  capture({{{100, 100}, {900, 100}, {900, 700}, {100, 700}}});  // y points down
  EXPECT_EQ(at(CalibrationStatus::COMPLETE).title, "z is down");
}

TEST_F(NextStep, CounterClockwiseCornersAreNotQuestioned) {
  capture({{{100, 700}, {900, 700}, {900, 100}, {100, 100}}});
  EXPECT_EQ(at(CalibrationStatus::COMPLETE).title, "Wave");
}

TEST_F(NextStep, ABadCornerIsTakenAgainAndAGoodRigSaved) {
  judge(CalibrationVerdict::REDO, 2);
  EXPECT_EQ(at(CalibrationStatus::SOLVED).request.command, Command::kCapture);
  EXPECT_EQ(guide_.advice(now_).request.corner, 2);
  judge(CalibrationVerdict::REDO);
  EXPECT_TRUE(at(CalibrationStatus::SOLVED).button.empty());
  judge(CalibrationVerdict::GOOD);
  EXPECT_EQ(at(CalibrationStatus::SOLVED).request.command, Command::kSave);
  status_.rig_id = "another";
  at(CalibrationStatus::SAVED);
  EXPECT_EQ(guide_.verdict(), nullptr);
}

TEST_F(NextStep, WhatIsCancelledRunsUntilItsOwnAnswer) {
  at(CalibrationStatus::READY);
  guide_.onRequest(Command::kSolve);
  answered(Command::kCancel);
  EXPECT_EQ(guide_.running(), Command::kSolve);
  guide_.onAnswer(Command::kSolve, false, "cancelled");
  EXPECT_EQ(guide_.running(), Command::kNone);
  EXPECT_EQ(guide_.answer(), "cancelled");
}

}  // namespace
}  // namespace wiimote_tracker::panel
