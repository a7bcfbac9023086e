// Cameras that were moved or exchanged, with cameras that this test plays: the rig that is loaded
// is not always the true one.

#include "calibrated_node.h"

#include "continuous/approach.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <rosgraph_msgs/Log.h>
#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/FitRemap.h>
#include <wiimote_tracker_msgs/JoinRig.h>
#include <wiimote_tracker_msgs/RemoveCamera.h>
#include <wiimote_tracker_msgs/SaveRig.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::AddKnownPlace;
using wiimote_tracker_msgs::FitRemap;
using wiimote_tracker_msgs::RemoveCamera;

class MovedCameras : public CalibratedNode {
 protected:
  /// Whether the camera's health is what continuous calibration proposes, and how to apply it.
  static bool isProposed(const std::string& camera) {
    return health(camera).find("; apply (A in calibrate) uses that") != std::string::npos;
  }
};

TEST_F(MovedCameras, WarnsOfCamerasThatAreNotWhereTheyWere) {
  Latest<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  cameras_->waveLed(true);
  load(trueRig());
  const auto says = [&](const std::string& camera, const std::string& part) {
    return waitUntil([&] { return health(camera).find(part) != std::string::npos; });
  };
  // Judged, and nothing found.
  ASSERT_TRUE(waitUntil([&] {
    const auto message = diagnostics.get();
    return message && message->status.front().message == "no camera seems to have moved";
  }));
  const auto healthy = status_->get();
  for (const auto& camera : healthy->cameras)
    EXPECT_EQ(camera.health, "") << camera.name;

  geometry::Rig rig = trueRig();
  rig.cameras[0].gravity =
      Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()) * *rig.cameras[0].gravity;
  rig.cameras[1].camera.identity = "00:1e:35:ff:ff:ff";
  rig.cameras[2].camera.intrinsics.cy += 5.0;
  std::atomic<bool> is_logged{false};
  const ros::Subscriber log = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
      "/rosout", 100, [&](const rosgraph_msgs::LogConstPtr& line) {
        if (line->msg.find("camera_2 is another device (00:") == 0)
          is_logged = true;
      });
  ASSERT_TRUE(waitUntil([&] { return log.getNumPublishers() >= 3; }));
  load(rig);
  EXPECT_TRUE(says("camera_1", "tilted by 5.7 degrees")) << health("camera_1");
  EXPECT_TRUE(says("camera_2", "another device")) << health("camera_2");
  EXPECT_TRUE(says("camera_3", "drifted")) << health("camera_3");
  EXPECT_EQ(health("camera_4"), "");
  EXPECT_TRUE(waitUntil([&] { return is_logged.load(); }));
  ASSERT_TRUE(waitUntil([&] {
    const auto message = diagnostics.get();
    const auto& status = message->status.front();
    return status.level == diagnostic_msgs::DiagnosticStatus::WARN &&
           status.message.find("camera_3 drifted") != std::string::npos;
  }));
  // Nothing was moved by itself.
  Latest<RigCalibration> published("calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return published.get() != nullptr; }));
  EXPECT_EQ(published.get()->id, rig.id());
}

TEST_F(MovedCameras, NamesCamerasThatAreNotInTheRig) {
  Latest<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  diagnostic_msgs::DiagnosticStatus found;  // another node publishes its own, too
  const auto says = [&](const std::string& part) {
    return waitUntil([&] {
      const auto message = diagnostics.get();
      if (message)
        found = message->status.front();
      return found.message.find(part) != std::string::npos;
    });
  };
  geometry::Rig rig = trueRig();
  rig.cameras.pop_back();
  rig.covariance.resize(0, 0);
  // Nothing is advised while a new rig is on the way.
  ASSERT_TRUE(start(2.5).success);
  load(rig);
  EXPECT_TRUE(says("no camera seems to have moved")) << found.message;
  ASSERT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(
      says("camera_4 is not in the rig and makes no points: add it (r camera_4 in calibrate), or "
           "end its driver"));
  EXPECT_EQ(found.level, diagnostic_msgs::DiagnosticStatus::WARN);
  load(trueRig());
  EXPECT_TRUE(
      says("no camera seems to have moved; the images are not judged: no LED has moved lately"));

  // Nor is a camera that was just removed.
  RemoveCamera::Request removed;
  removed.camera = "camera_4";
  ASSERT_TRUE(call<RemoveCamera>("calibration/remove_camera", removed).success);
  ASSERT_TRUE(waitUntil([&] {
    found = diagnostics.get()->status.front();
    return std::none_of(found.values.begin(), found.values.end(), [](const auto& value) {
      return value.key.find("camera_4") != std::string::npos;
    });
  }));
  EXPECT_EQ(found.message.find("camera_4"), std::string::npos) << found.message;
}

TEST_F(MovedCameras, BringsBackAKnockedCamera) {
  geometry::Rig rig = trueRig();
  Eigen::Isometry3d& pose = rig.cameras[1].camera.world_from_camera;
  pose.linear() = pose.linear() * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY());
  rig.cameras[1].masks = {{{1000.0, 20.0}, 5.0}};
  load(rig);
  // Soon what was proposed for the rig of the test before is forgotten.
  EXPECT_TRUE(waitUntil([] {
    const auto reply = call<std_srvs::Trigger>("calibration/continuous/apply");
    return !reply.success && reply.message.find("nothing is proposed") == 0;
  }));
  // A node that applies what it finds, with the cameras' full names.
  geometry::Rig other = rig;
  for (geometry::RigCamera& camera : other.cameras)
    camera.camera.name = "/" + camera.camera.name;
  load(other, "knocked/calibration/load");
  Latest<RigCalibration> applied("knocked/calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return applied.get() != nullptr; }));
  EXPECT_EQ(applied.get()->id, other.id());

  // Proposed, and not applied.
  cameras_->waveLed(true);
  ASSERT_TRUE(waitUntil([] { return isProposed("camera_2"); }));
  EXPECT_EQ(status_->get()->rig_id, rig.id());
  const std::string proposed = health("camera_2");
  EXPECT_EQ(proposed.find("put it back"), std::string::npos) << proposed;
  EXPECT_EQ(proposed.find("camera_2"), std::string::npos) << proposed;  // whose health it is
  EXPECT_EQ(status_->get()->next_title, "Correct camera_2");
  EXPECT_EQ(status_->get()->next_request, "continuous/apply");
  const auto reply = call<std_srvs::Trigger>("calibration/continuous/apply");
  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_SAYS(reply.message, "camera_2 was turned by 2.8");
  EXPECT_SAYS(reply.message, "the masks of camera_2 cover where lamps were before: switch");
  EXPECT_SAYS(reply.message, folder_ + "/versions/");
  EXPECT_SAYS(reply.message, "; revert (b in calibrate) goes back, and save keeps it");
  EXPECT_SAYS(call<std_srvs::Trigger>("calibration/continuous/apply").message, "nothing");
  Latest<RigCalibration> published("calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return published.get() && published.get()->id != rig.id(); }));
  const geometry::Rig result = fromMessage(*published.get());
  EXPECT_LT((result.cameras[1].camera.center() - cameras_->truth[1].center()).norm(), 0.01);
  EXPECT_TRUE(waitUntil([] { return health("camera_2").empty(); }));
  // Back, once.
  ASSERT_TRUE(call<std_srvs::Trigger>("calibration/continuous/revert").success);
  const ros::Time reverted = ros::Time::now();
  EXPECT_TRUE(waitUntil([&] { return published.get()->id == rig.id(); }));
  EXPECT_SAYS(call<std_srvs::Trigger>("calibration/continuous/revert").message,
              "load an earlier rig of " + folder_ + "/: one of versions/");
  // Proposed again from later images only, of which it takes ten seconds.
  EXPECT_TRUE(waitUntil([] { return isProposed("camera_2"); }));
  EXPECT_GT((ros::Time::now() - reverted).toSec(), 9.0);
  load(trueRig());
  EXPECT_TRUE(waitUntil([] { return health("camera_2").empty(); }));

  EXPECT_TRUE(waitUntil([&] { return applied.get()->id != other.id(); }));
  EXPECT_LT(
      (fromMessage(*applied.get()).cameras[1].camera.center() - cameras_->truth[1].center()).norm(),
      0.01);
  std::string rig_file;
  ASSERT_TRUE(ros::param::get("/knocked/calibration/rig_file", rig_file));
  const std::string folder = rig_file.substr(0, rig_file.rfind('/'));
  EXPECT_TRUE(waitUntil([&] { return exists(folder + "/versions"); }));
  EXPECT_FALSE(exists(rig_file));
  ASSERT_EQ(folder.compare(0, 5, "/tmp/"), 0);
  EXPECT_TRUE(waitUntil([&] {  // the node may still be writing the version
    std::error_code error;
    std::filesystem::remove_all(folder, error);
    return !error;
  }));
}

TEST_F(MovedCameras, ArePointedOutWhileTwoPersonsCarryLeds) {
  geometry::Rig rig = trueRig();
  Eigen::Isometry3d& pose = rig.cameras[1].camera.world_from_camera;
  pose.linear() = pose.linear() * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY());
  cameras_->waveLed(true);
  cameras_->waveSecondLed(true);
  load(rig);
  const auto says = [](const char* part) {
    return waitUntil([&] { return health("camera_2").find(part) != std::string::npos; });
  };
  EXPECT_TRUE(says("drifted: its images are ")) << health("camera_2");
  EXPECT_TRUE(waitUntil([] { return isProposed("camera_2"); })) << health("camera_2");
  EXPECT_SAYS(health("camera_2"), "; it was turned by");
  for (const char* const camera : {"camera_1", "camera_3", "camera_4"})
    EXPECT_EQ(health(camera), "") << camera;
  const auto reply = call<std_srvs::Trigger>("calibration/continuous/apply");
  EXPECT_TRUE(reply.success) << reply.message;
  EXPECT_SAYS(reply.message, "camera_2 was turned by 2.8");
}

TEST_F(MovedCameras, SaysThatTwoCamerasAreNotCorrected) {
  geometry::Rig rig = trueRig();
  rig.cameras.resize(2);
  rig.covariance = Eigen::MatrixXd::Zero(32, 32);
  load(rig);
  EXPECT_TRUE(waitUntil([] {  // what was proposed for the rig before is forgotten
    return call<std_srvs::Trigger>("calibration/continuous/apply")
               .message.find("put it back, or calibrate all cameras again") != std::string::npos;
  }));
}

TEST_F(MovedCameras, DoesNotApplyWhatPairsOfCamerasContradict) {
  geometry::Rig rig = trueRig();
  // About the vertical: the accelerometer does not tell which pair was moved.
  const Eigen::Vector3d center = rig.cameras[0].camera.center();
  const Eigen::Isometry3d turn = Eigen::Translation3d(center) *
                                 Eigen::AngleAxisd(0.035, Eigen::Vector3d::UnitZ()) *
                                 Eigen::Translation3d(-center);
  for (const std::size_t i : {0, 1}) {
    Eigen::Isometry3d& pose = rig.cameras[i].camera.world_from_camera;
    pose = turn * pose;
  }
  const auto isRefused = [](const std::string& why) {
    return waitUntil([&] {
      const auto reply = call<std_srvs::Trigger>("calibration/continuous/apply");
      return !reply.success && reply.message.find(why) != std::string::npos;
    });
  };
  load(rig);
  cameras_->waveLed(true);
  EXPECT_TRUE(isRefused("contradict the others"));
  // Nothing is said of a rig that was replaced, though no image judges the new one.
  const geometry::Rig other = trueRig();
  cameras_.reset();
  EXPECT_TRUE(waitUntil([] {
    const auto& cameras = status_->get()->cameras;
    return std::none_of(cameras.begin(), cameras.end(),
                        [](const auto& camera) { return camera.connected; });
  }));
  load(other);
  EXPECT_TRUE(isRefused("nothing is proposed: a camera that no longer fits"));
  cameras_ = std::make_unique<FakeCameras>();
}

TEST_F(MovedCameras, FindsANewClockAndApproachesTheAdjustedPoses) {
  geometry::Rig rig = trueRig();
  Eigen::Isometry3d& pose = rig.cameras[1].camera.world_from_camera;
  pose.linear() = pose.linear() * Eigen::AngleAxisd(0.001, Eigen::Vector3d::UnitY());
  rig.cameras[2].time_offset = 0.01;
  rig.cameras[2].time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  rig.cameras[2].time_offset_epoch = 0;
  rig.cameras[3].masks = {{{1000.0, 20.0}, 5.0}};
  load(rig);
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  putLed(place);
  cameras_->blind({"camera_2"});  // whose pose in the rig is wrong
  AddKnownPlace::Request known;
  known.known = pointOf(1.02 * place);
  const auto measured = call<AddKnownPlace>("calibration/known_places/add", known);
  ASSERT_TRUE(measured.success) << measured.message;
  cameras_->blind({});
  cameras_->waveLed(true);
  ASSERT_TRUE(waitUntil([] { return isProposed("camera_3"); }));
  // The first step may come before the reply, which is then the newest message.
  std::atomic<bool> says_approached{false};
  const ros::Subscriber statuses = ros::NodeHandle().subscribe<CalibrationStatus>(
      "calibration/status", 100, [&](const boost::shared_ptr<const CalibrationStatus>& status) {
        if (status->message.find("the adjusted rig is approached") == 0)
          says_approached = true;
      });
  ASSERT_TRUE(waitUntil([&] { return statuses.getNumPublishers() >= 1; }));
  const auto reply = call<std_srvs::Trigger>("calibration/continuous/apply");
  ASSERT_TRUE(reply.success) << reply.message;
  for (const char* text : {"approached in steps of 0.2 mm", "camera_3", "save keeps it"})
    EXPECT_SAYS(reply.message, text);
  EXPECT_TRUE(waitUntil([] { return status_->get()->next_title == "Wait"; }));
  Latest<RigCalibration> published("calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return published.get() && published.get()->id != rig.id(); }));
  const geometry::Rig result = fromMessage(*published.get());
  // The first step towards it.
  EXPECT_TRUE(waitUntil([&] { return says_approached.load(); }));
  const std::vector<Eigen::Vector3d> middle = {{1.25, 1.25, 1.0}};
  EXPECT_GT(continuous::movementOf(rig, result, middle), 0.00001);
  EXPECT_LT(continuous::movementOf(rig, result, middle), 0.00022);
  // What is saved meanwhile is what is approached.
  wiimote_tracker_msgs::SaveRig::Request save;
  save.path = folder_ + "/approached.yaml";
  EXPECT_SAYS(call<wiimote_tracker_msgs::SaveRig>("calibration/save", save).message,
              "the corrected rig, which the one in use still approaches");
  EXPECT_GT(continuous::movementOf(result, geometry::readRigFile(save.path), middle), 0.0003);
  // That is also what is joined.
  wiimote_tracker_msgs::JoinRig::Request join;
  join.path = save.path;
  EXPECT_SAYS(call<wiimote_tracker_msgs::JoinRig>("calibration/join", join).message,
              "both are the same rig");
  EXPECT_EQ(result.cameras[2].time_offset_epoch, 1U);
  EXPECT_NEAR(result.cameras[2].time_offset, 0.0, 0.002);
  // What was measured stays.
  EXPECT_SAYS(call<FitRemap>("calibration/known_places/fit").message, "1 known point");
  // Nor does a correction of the volume end the approach.
  cameras_->waveLed(false);
  cameras_->blind({"camera_2"});
  measureLargerWorld(1);
  const auto fitted = call<FitRemap>("calibration/known_places/fit");
  ASSERT_TRUE(fitted.success) << fitted.message;
  EXPECT_SAYS(call<wiimote_tracker_msgs::SaveRig>("calibration/save", save).message,
              "the corrected rig, which the one in use still approaches");
  const geometry::Rig saved = geometry::readRigFile(save.path);
  ASSERT_TRUE(saved.remap);
  EXPECT_EQ(saved.remap->rig_id, saved.id());
  // Back, once, though the masks were cleared meanwhile; they stay so.
  ASSERT_TRUE(call<std_srvs::Trigger>("calibration/clear_masks").success);
  rig.cameras[3].masks.clear();
  ASSERT_TRUE(call<std_srvs::Trigger>("calibration/continuous/revert").success);
  EXPECT_TRUE(waitUntil([&] { return published.get()->id == rig.id(); }));
  EXPECT_FALSE(call<std_srvs::Trigger>("calibration/continuous/revert").success);
}

}  // namespace
}  // namespace wiimote_tracker
