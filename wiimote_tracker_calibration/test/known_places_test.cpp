// Measurements with a calibrated rig, with cameras that this test plays: the rig that is loaded is
// not always the true one.

#include "calibrated_node.h"

#include <rosgraph_msgs/Log.h>
#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/FitRemap.h>
#include <wiimote_tracker_msgs/LearnMasks.h>

#include <atomic>
#include <future>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::AddKnownPlace;
using wiimote_tracker_msgs::CheckPlace;
using wiimote_tracker_msgs::FitRemap;
using wiimote_tracker_msgs::LearnMasks;

TEST_F(CalibratedNode, ChecksAKnownPlace) {
  load(trueRig());
  const Eigen::Vector3d place(1.0, 0.8, 0.3);
  putLed(place);
  std::atomic<bool> is_logged{false};
  const ros::Subscriber log = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
      "/rosout", 100, [&](const rosgraph_msgs::LogConstPtr& line) {
        if (line->msg.find("Check at (1.000, 0.800, 0.300) m: measured ") == 0)
          is_logged = true;
      });
  ASSERT_TRUE(waitUntil([&] { return log.getNumPublishers() >= 3; }));
  CheckPlace::Response response = check(place);
  EXPECT_TRUE(waitUntil([&] { return is_logged.load(); }));
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_TRUE(response.consistent) << response.message;
  EXPECT_LT(response.error, 0.005);
  EXPECT_GT(response.expected_stddev, 0.001);
  EXPECT_GT(response.covariance[0], 0.0);
  EXPECT_EQ(response.cameras.size(), 4u);
  EXPECT_EQ(response.residual.size(), 4u);
  EXPECT_SAYS(response.message, "holds");
  EXPECT_TRUE(waitUntil([&] { return status_->get()->message == response.message; }));

  // Refused before anything is measured.
  cameras_->switchLed(false);
  CheckPlace::Request to_solve;
  to_solve.known = pointOf(place);
  EXPECT_SAYS(call<CheckPlace>("calibration/measure_place", to_solve).message,
              "capture its four corners first");
  cameras_->switchLed(true);

  response = check(place + Eigen::Vector3d(0.05, 0.0, 0.0));
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_FALSE(response.consistent);
  EXPECT_NEAR(response.error, 0.05, 0.005);

  geometry::Rig moved = trueRig();
  moved.cameras[1].camera.intrinsics.cy += 20.0;
  load(moved);
  response = check(place);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_SAYS(response.message, "camera_2 contradicts");
}

TEST_F(CalibratedNode, RefusesAMeasurementWithTheReason) {
  load(trueRig());
  putLed({1.0, 0.8, 0.3});
  cameras_->blind({"camera_1", "camera_2", "camera_3"});
  CheckPlace::Response response = check({1.0, 0.8, 0.3});
  EXPECT_FALSE(response.success);
  EXPECT_SAYS(response.message, "sees no spot");
  EXPECT_TRUE(std::isnan(response.error));
  EXPECT_TRUE(std::isnan(response.measured.x));
  // Refused before anything is measured.
  EXPECT_SAYS(check({std::nan(""), 0.8, 0.3}).message, "not finite");
  CheckPlace::Request request;
  request.duration = 0.001;  // shorter than one image takes
  EXPECT_SAYS(call<CheckPlace>("calibration/check", request).message, "0.05 and 3600 s");
  request.known_stddev = -1.0;
  EXPECT_SAYS(call<CheckPlace>("calibration/check", request).message, "known_stddev");
  cameras_->blind({});

  // Cancelled while it waits, longer than anything here takes.
  cameras_->switchLed(false);
  ASSERT_TRUE(waitForStatus()) << "the measurement before is over";
  auto waiting = std::async(std::launch::async, [&] {
    return check({1.0, 0.8, 0.3}, 2.0 * kPatience);
  });
  ASSERT_TRUE(waitForStep(CalibrationStatus::MEASURING));
  // Another one is refused, and does not end it.
  EXPECT_SAYS(check({1.0, 0.8, 0.3}).message, "is being measured: wait");
  EXPECT_TRUE(waitUntil(
      [] { return status_->get()->message.find("is being measured") != std::string::npos; }));
  EXPECT_EQ(status_->get()->step, CalibrationStatus::MEASURING);
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_SAYS(waiting.get().message, "cancelled");
}

TEST_F(CalibratedNode, CorrectsTheVolumeFromKnownPlaces) {
  load(trueRig());
  call<std_srvs::Trigger>("calibration/known_places/clear");
  EXPECT_FALSE(call<std_srvs::Trigger>("calibration/known_places/undo").success);
  EXPECT_SAYS(call<FitRemap>("calibration/known_places/fit").message,
              "only 0 known points, too few");

  measureLargerWorld(0);
  AddKnownPlace::Request request;
  request.known = pointOf({2100.0, 2100.0, 1600.0});
  EXPECT_SAYS(call<AddKnownPlace>("calibration/known_places/add", request).message, "millimetres");
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/known_places/undo").success);

  FitRemap::Request fit;
  fit.models = {"bent"};
  EXPECT_FALSE(call<FitRemap>("calibration/known_places/fit", fit).success);
  fit.models = {"affine"};
  const auto fitted = call<FitRemap>("calibration/known_places/fit", fit);
  ASSERT_TRUE(fitted.success) << fitted.message;
  EXPECT_EQ(fitted.model, "affine");
  EXPECT_GT(fitted.uncorrected_error, 0.02);
  EXPECT_LT(fitted.expected_error, 0.01);
  EXPECT_FALSE(fitted.table.empty());

  Latest<RigCalibration> rig("calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return rig.get() && rig.get()->remap.model == "affine"; }));
  EXPECT_EQ(rig.get()->remap.rig_id, rig.get()->id);
  // What is measured from now on is corrected.
  const Eigen::Vector3d place(1.2, 1.3, 0.8);
  putLed(place);
  const CheckPlace::Response checked = check(1.02 * place);
  EXPECT_TRUE(checked.success) << checked.message;
  EXPECT_LT(checked.error, 0.005);

  // Masks move no point: the places stay.
  LearnMasks::Request masks;
  masks.duration = 0.5;
  LearnMasks::Response learned;
  ASSERT_TRUE(waitUntil([&] {  // a busy computer may send too few images in that time
    learned = call<LearnMasks>("calibration/learn_masks", masks);
    return learned.success;
  })) << learned.message;
  EXPECT_SAYS(learned.message, "the rig in use has the masks now");
  const auto again = call<FitRemap>("calibration/known_places/fit", fit);
  EXPECT_TRUE(again.success) << again.message;

  // Another calibration: the places are worth nothing.
  geometry::Rig other = trueRig();
  other.cameras[0].camera.intrinsics.fx += 1.0;
  load(other);
  EXPECT_SAYS(call<FitRemap>("calibration/known_places/fit").message, "8 places");
}

}  // namespace
}  // namespace wiimote_tracker
