// What the Tracker panel shows of the calibration node's messages.

#include "guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

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
  void answered(const std::string& service, const std::string& text = "done") {
    guide_.onRequest(service);
    guide_.onAnswer(service, text);
  }

  Guide guide_;
  CalibrationStatus status_;
  double now_ = 100.0;
};

TEST_F(NextStep, WithoutANodeItSaysHowToStartIt) {
  EXPECT_EQ(guide_.advice(now_).title, "No node");
  EXPECT_NE(guide_.advice(now_).sentence.find("ROS_NAMESPACE"), std::string::npos);
  at(CalibrationStatus::IDLE);
  now_ += 4.0;
  EXPECT_EQ(guide_.advice(now_).title, "No node");
  EXPECT_TRUE(guide_.advice(now_).button.empty());
}

TEST_F(NextStep, IsWhatTheNodeSays) {
  status_.next_title = "Corner 3";
  status_.next_sentence = "Put the LED on corner 3 again.";
  status_.next_request = "capture_corner";
  status_.next_label = "capture corner 3 again";
  status_.next_corner = 2;
  const Advice advice = at(CalibrationStatus::SOLVED);
  EXPECT_EQ(advice.title, "Corner 3");
  EXPECT_EQ(advice.sentence, "Put the LED on corner 3 again.");
  EXPECT_EQ(advice.button, "Capture corner 3 again");
  EXPECT_EQ(advice.request, "capture_corner");
  EXPECT_EQ(advice.corner, 2);
}

TEST_F(NextStep, OffersWhatContinuousCalibrationProposes) {
  status_.next_request = "continuous/apply";
  status_.next_label = "correct it";
  EXPECT_EQ(at(CalibrationStatus::SAVED).button, "Correct it");
  EXPECT_EQ(guide_.advice(now_).request, "continuous/apply");
}

TEST_F(NextStep, HasNoButtonWhereThereIsNothingToRequest) {
  for (const char* request : {"", "of_a_newer_node"}) {
    status_.next_request = request;
    status_.next_label = "do it";
    EXPECT_TRUE(at(CalibrationStatus::READY).button.empty());
  }
}

TEST_F(NextStep, TheWalkAndWhatIsMissingAreRemarks) {
  status_.missing = {"wave higher"};
  status_.walk = "the walk";
  at(CalibrationStatus::WAVING);
  EXPECT_EQ(guide_.remarks(), (std::vector<std::string>{"the walk", "wave higher"}));
}

TEST_F(NextStep, SpotsOfACameraAreNoProblemOnceThereIsARig) {
  status_.cameras.resize(1);
  status_.cameras[0].name = "a";
  status_.cameras[0].problem = "sees 4 spots";
  status_.cameras[0].health = "moved";
  at(CalibrationStatus::READY);
  EXPECT_EQ(guide_.remarks(), (std::vector<std::string>{"a: sees 4 spots", "a: moved"}));
  at(CalibrationStatus::SAVED);
  EXPECT_EQ(guide_.remarks(), std::vector<std::string>{"a: moved"});
}

TEST_F(NextStep, NothingCanBePressedUntilAnAnswerAndItsEffectAreKnown) {
  at(CalibrationStatus::IDLE);
  EXPECT_FALSE(guide_.isWaiting());
  guide_.onRequest("learn_masks");
  EXPECT_TRUE(guide_.isWaiting());
  guide_.onAnswer("learn_masks", "done");
  EXPECT_TRUE(guide_.isWaiting());
  at(CalibrationStatus::IDLE);
  EXPECT_FALSE(guide_.isWaiting());
}

TEST_F(NextStep, ARefusalStaysUntilTheNodeSaysSomethingNew) {
  status_.message = "ready";
  at(CalibrationStatus::READY);
  answered("capture_corner", "refused: the LED is hidden");
  at(CalibrationStatus::READY);
  EXPECT_EQ(guide_.answer(), "refused: the LED is hidden");
  status_.message = "corner 1 captured";
  at(CalibrationStatus::READY);
  EXPECT_EQ(guide_.answer(), "corner 1 captured");
}

TEST_F(NextStep, ANodeThatWasStartedAgainAmidACalibrationHasLostIt) {
  status_.header.seq = 50;
  at(CalibrationStatus::WAVING);
  status_.header.seq = 0;
  status_.message = "the old rig is in use";
  at(CalibrationStatus::SAVED);
  EXPECT_NE(guide_.answer().find("is lost. Start again."), std::string::npos);
  answered("start", "started");
  EXPECT_EQ(guide_.answer(), "started");
  status_.header.seq = 50;
  at(CalibrationStatus::SAVED);
  status_.header.seq = 0;
  status_.message = "the same rig is in use";
  at(CalibrationStatus::SAVED);
  EXPECT_EQ(guide_.answer(), "the same rig is in use");
}

TEST_F(NextStep, AVerdictIsThatOfTheRigInUse) {
  CalibrationVerdict verdict;
  verdict.rig_id = status_.rig_id = "rig";
  guide_.onVerdict(verdict);
  at(CalibrationStatus::SOLVED);
  EXPECT_NE(guide_.verdict(), nullptr);
  at(CalibrationStatus::WAVING);  // for the next rig
  EXPECT_EQ(guide_.verdict(), nullptr);
  status_.rig_id = "another";
  at(CalibrationStatus::SAVED);
  EXPECT_EQ(guide_.verdict(), nullptr);
}

TEST_F(NextStep, ProgressIsThatOfTheCaptureOrOfTheNode) {
  EXPECT_EQ(guide_.progress(), 0.0);
  status_.progress = 0.25;
  at(CalibrationStatus::WAVING);
  guide_.onRequest("solve");
  guide_.onProgress("", 0.75);
  EXPECT_EQ(guide_.progress(), 0.25);
  guide_.onAnswer("solve", "done");
  guide_.onRequest("capture_corner");
  EXPECT_EQ(guide_.progress(), 0.0);
  guide_.onProgress("1 of 2 samples", 0.5);
  EXPECT_EQ(guide_.progress(), 0.5);
  EXPECT_EQ(guide_.answer(), "1 of 2 samples");
  guide_.onAnswer("capture_corner", "done");
  status_.progress = NAN;
  at(CalibrationStatus::READY);
  EXPECT_EQ(guide_.progress(), 0.0) << "not known";
}

TEST_F(NextStep, WhatIsCancelledRunsUntilItsOwnAnswer) {
  at(CalibrationStatus::READY);
  guide_.onRequest("solve");
  answered("cancel");
  EXPECT_EQ(guide_.running(), "solve");
  guide_.onAnswer("solve", "cancelled");
  EXPECT_EQ(guide_.running(), "");
  EXPECT_EQ(guide_.answer(), "cancelled");
}

}  // namespace
}  // namespace wiimote_tracker::panel
