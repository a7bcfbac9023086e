// What the Tracker panel says about cameras, from messages and times, without nodes and widgets.

#include "tracker_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {
namespace {

using wiimote_tracker_msgs::IrBlob;
using wiimote_tracker_msgs::IrBlobArray;

constexpr double kPeriod = 0.01;  // [s]
constexpr double kDelay = 0.015;  // [s]

IrBlobArray image(std::uint64_t frame, const std::vector<std::pair<double, double>>& spots) {
  IrBlobArray message;
  message.width = 1024;
  message.height = 768;
  message.frame = frame;
  for (const auto& [x, y] : spots) {
    IrBlob blob;
    blob.x = x;
    blob.y = y;
    message.blobs.push_back(blob);
  }
  return message;
}

wiimote_tracker_msgs::RigCalibration rigOf(const std::vector<std::string>& names) {
  wiimote_tracker_msgs::RigCalibration rig;
  for (const std::string& name : names) {
    rig.cameras.emplace_back();
    rig.cameras.back().name = name;
  }
  return rig;
}

wiimote_tracker_msgs::CalibrationStatus statusOfKnocked(const std::string& camera) {
  wiimote_tracker_msgs::CalibrationStatus status;
  status.cameras.emplace_back();
  status.cameras[0].name = camera;
  status.cameras[0].health = "it was tilted by 3 degrees: calibrate it again";
  return status;
}

class View : public testing::Test {
 protected:
  /// Every camera sends an image with one spot, or none, each period.
  void run(double duration,
           const std::vector<std::string>& lit,
           const std::vector<std::string>& dark,
           double delay = kDelay) {
    for (const double end = now_ + duration; now_ < end; now_ += kPeriod) {
      ++frame_;
      for (const std::string& name : lit)
        view_.onImage(name, image(frame_, {{100.0, 200.0}}), delay, now_);
      for (const std::string& name : dark)
        view_.onImage(name, image(frame_, {}), delay, now_);
    }
  }

  const CameraView& camera(const std::string& name) const {
    for (const CameraView& camera : view_.cameras()) {
      if (camera.name == name)
        return camera;
    }
    throw std::out_of_range(name);
  }
  CameraState state(const std::string& name) const { return view_.stateOf(camera(name), now_); }
  std::string words(const std::string& name) const { return view_.wordsOf(camera(name), now_); }

  TrackerView view_;
  double now_ = 1000.0;
  std::uint64_t frame_ = 0;
};

TEST_F(View, SaysWhatToDoWithoutCameras) {
  EXPECT_EQ(view_.summary(now_), "No camera is there: start the drivers.");
}

TEST_F(View, SaysWhatToDoWithoutACalibration) {
  run(0.1, {"a"}, {});
  EXPECT_EQ(view_.summary(now_), "1 camera: 1 not calibrated. Open the page Calibrate.");
}

TEST_F(View, ACalibratedCameraWithImagesIsFine) {
  view_.onRig(rigOf({"a"}), now_);
  run(2.0, {"a"}, {});
  EXPECT_EQ(state("a"), CameraState::kFine);
  EXPECT_EQ(words("a"), "fine, sees 1 spot");
  EXPECT_NEAR(camera("a").rate(now_), 100.0, 1.0);
}

TEST_F(View, ACameraOutsideOfTheRigIsNotCalibrated) {
  view_.onRig(rigOf({"a"}), now_);
  run(0.1, {"a"}, {"b"});
  EXPECT_EQ(state("b"), CameraState::kNotCalibrated);
  EXPECT_EQ(words("b"), "not calibrated, sees 0 spots");
  EXPECT_EQ(view_.summary(now_), "2 cameras: 1 not calibrated, 1 fine");
}

TEST_F(View, ACameraThatStopsIsFrozenWithinASecond) {
  view_.onRig(rigOf({"a", "b"}), now_);
  run(1.0, {"a", "b"}, {});
  run(0.9, {"a"}, {});
  EXPECT_EQ(state("b"), CameraState::kFine);
  run(0.2, {"a"}, {});
  EXPECT_EQ(state("b"), CameraState::kFrozen);
  run(7.0, {"a"}, {});
  EXPECT_EQ(words("b"), "no images for 8 s: check battery and link");
  EXPECT_TRUE(std::isnan(camera("b").rate(now_)));
  EXPECT_EQ(view_.summary(now_), "2 cameras: 1 without images (b), 1 fine");
}

TEST_F(View, ACameraOfTheRigThatNeverSentIsShown) {
  view_.onRig(rigOf({"a"}), now_);
  EXPECT_EQ(words("a"), "waiting for its images");
  now_ += 3.0;
  EXPECT_EQ(words("a"), "no images for 3 s: check battery and link");
}

TEST_F(View, ACameraThatSeesNothingWhileOthersDoIsBlind) {
  view_.onRig(rigOf({"a", "b"}), now_);
  run(6.0, {"a"}, {"b"});
  EXPECT_EQ(state("b"), CameraState::kBlind);
  EXPECT_EQ(view_.summary(now_), "2 cameras: 1 without spots (b), 1 fine");
  run(6.0, {}, {"a", "b"});  // the LED is off
  EXPECT_EQ(state("b"), CameraState::kFine);
}

TEST_F(View, AMaskedSpotIsNoSpot) {
  auto rig = rigOf({"a"});
  rig.cameras[0].masks.emplace_back();
  rig.cameras[0].masks[0].x = 105.0;
  rig.cameras[0].masks[0].y = 200.0;
  rig.cameras[0].masks[0].radius = 10.0;
  view_.onRig(rig, now_);
  run(0.1, {"a"}, {});
  EXPECT_EQ(words("a"), "fine, sees 0 spots");
}

TEST_F(View, LateImagesAreLateAndAncientOnesARecording) {
  view_.onRig(rigOf({"a"}), now_);
  run(1.0, {"a"}, {}, 0.25);
  EXPECT_EQ(state("a"), CameraState::kLate);
  EXPECT_EQ(words("a"), "images come 250 ms late");
  now_ += 2.0;
  run(1.0, {"a"}, {}, -0.25);
  EXPECT_EQ(words("a"), "its clock is 250 ms ahead: run chrony on all computers");
  now_ += 2.0;
  run(1.0, {"a"}, {}, 1e6);
  EXPECT_EQ(words("a"), "its stamps are not of now: a recording, or a clock that is wrong");
}

TEST_F(View, AKnockedCameraSaysWhatTheHealthWatchSays) {
  view_.onRig(rigOf({"a"}), now_);
  run(0.1, {"a"}, {});
  const wiimote_tracker_msgs::CalibrationStatus status = statusOfKnocked("a");
  view_.onStatus(status, now_);
  EXPECT_EQ(state("a"), CameraState::kKnocked);
  EXPECT_EQ(words("a"), status.cameras[0].health);
}

TEST_F(View, ACameraOfWhichTheTrackerWarnsSaysSoWhileItWarns) {
  auto rig = rigOf({"a", "b"});
  rig.id = "0123456789abcdef";
  view_.onRig(rig, now_);
  run(0.1, {"a", "b"}, {});
  diagnostic_msgs::DiagnosticArray message;
  message.status.resize(3);
  message.status[0].name = "triangulation: a";
  message.status[0].hardware_id = "rig " + rig.id;
  message.status[0].level = diagnostic_msgs::DiagnosticStatus::WARN;
  message.status[0].message = "its images are ignored";
  message.status[1] = message.status[0];  // not the tracker's
  message.status[1].name = "driver: Wii Remote b";
  message.status[1].hardware_id = "00:1e:35:00:00:03";
  message.status[2] = message.status[0];  // of another room
  message.status[2].name = "/room2/triangulation: b";
  message.status[2].hardware_id = "rig fedcba9876543210";
  view_.onDiagnostics(message, now_);
  EXPECT_EQ(state("a"), CameraState::kWarned);
  EXPECT_EQ(words("a"), "its images are ignored");
  EXPECT_EQ(state("b"), CameraState::kFine);
  EXPECT_EQ(view_.summary(now_), "2 cameras: 1 with a warning of the tracker (a), 1 fine");
  message.status[0].level = diagnostic_msgs::DiagnosticStatus::OK;
  view_.onDiagnostics(message, now_);
  EXPECT_EQ(state("a"), CameraState::kFine);
  message.status[0].level = diagnostic_msgs::DiagnosticStatus::WARN;
  view_.onDiagnostics(message, now_);
  run(CameraView::kWarnedFor + 0.1, {"a", "b"}, {});  // the tracker has ended
  EXPECT_EQ(state("a"), CameraState::kFine);
}

TEST_F(View, ACameraThatTheCalibrationNodeNoLongerWatchesIsNotKnockedAnyMore) {
  view_.onRig(rigOf({"a"}), now_);
  run(0.1, {"a"}, {});
  wiimote_tracker_msgs::CalibrationStatus status = statusOfKnocked("a");
  view_.onStatus(status, now_);
  ASSERT_EQ(state("a"), CameraState::kKnocked);
  status.cameras.clear();
  view_.onStatus(status, now_);
  EXPECT_EQ(state("a"), CameraState::kFine);
}

TEST_F(View, ACameraOfTheCalibrationNodeStays) {
  wiimote_tracker_msgs::CalibrationStatus status;
  status.cameras.emplace_back();
  status.cameras[0].name = "a";
  view_.onStatus(status, now_);
  now_ += TrackerView::kForgetAfter + 1.0;
  view_.onTopics({}, now_);
  EXPECT_EQ(view_.cameras().size(), 1u);
  status.cameras.clear();
  view_.onStatus(status, now_);
  view_.onTopics({}, now_);
  EXPECT_TRUE(view_.cameras().empty());
}

TEST_F(View, TheRateSurvivesARestartOfTheDriver) {
  run(3.0, {"a"}, {});
  frame_ = 0;
  run(0.5, {"a"}, {});
  EXPECT_NEAR(camera("a").rate(now_), 100.0, 3.0);
}

TEST_F(View, FortyCamerasAreInTheOrderOfTheirNumbers) {
  std::set<std::string> names;
  for (int i = 1; i <= 40; ++i)
    names.insert("wiimote_" + std::to_string(i));
  view_.onTopics(names, now_);
  ASSERT_EQ(view_.cameras().size(), 40u);
  for (std::size_t i = 0; i < 40; ++i)
    EXPECT_EQ(view_.cameras()[i].name, "wiimote_" + std::to_string(i + 1));
}

TEST_F(View, ACameraWithoutTopicIsForgottenUnlessTheRigHasIt) {
  view_.onRig(rigOf({"a"}), now_);
  view_.onTopics({"a", "b"}, now_);
  run(1.0, {"a", "b"}, {});
  now_ += 11.0;
  view_.onTopics({}, now_);
  ASSERT_EQ(view_.cameras().size(), 1u);
  EXPECT_EQ(view_.cameras()[0].name, "a");
}

}  // namespace
}  // namespace wiimote_tracker::panel
