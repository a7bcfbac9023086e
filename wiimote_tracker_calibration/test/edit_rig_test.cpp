// Cameras of a rig that are solved again, added and removed, with cameras that this test plays.

#include "calibrated_node.h"
#include "split_rig.h"

#include "recalibrate/rig_cameras.h"

#include <wiimote_tracker_msgs/RecalibrateCamera.h>
#include <wiimote_tracker_msgs/RemoveCamera.h>
#include <wiimote_tracker_msgs/StartBoard.h>

#include <limits>
#include <string>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::RecalibrateCamera;
using wiimote_tracker_msgs::RemoveCamera;

// Longer than the test may take: for what is refused before anybody waves.
constexpr double kForEver = 300.0;  // [s]

class EditRig : public CalibratedNode {
 protected:
  /// @param duration of the wave [s]
  static RecalibrateCamera::Response recalibrate(const std::string& camera,
                                                 double duration = 6.0,
                                                 const std::string& name_space = "") {
    RecalibrateCamera::Request request;
    request.camera = camera;
    request.duration = duration;
    return call<RecalibrateCamera>(name_space + "calibration/recalibrate_camera", request);
  }

  static RemoveCamera::Response remove(const std::string& camera) {
    RemoveCamera::Request request;
    request.camera = camera;
    return call<RemoveCamera>("calibration/remove_camera", request);
  }

  /// The true rig in the eyes of a node in a namespace.
  static geometry::Rig withSlashes() {
    geometry::Rig rig = trueRig();
    for (geometry::RigCamera& camera : rig.cameras)
      camera.camera.name = "/" + camera.camera.name;
    return rig;
  }
};

TEST_F(EditRig, RecalibratesOneCamera) {
  geometry::Rig rig = trueRig();
  Eigen::Isometry3d& pose = rig.cameras[1].camera.world_from_camera;
  pose.translation() += Eigen::Vector3d(0.05, 0.0, 0.0);
  pose.linear() = pose.linear() * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY());
  rig.cameras[1].masks = {{{1000.0, 20.0}, 5.0}};
  load(rig);
  EXPECT_SAYS(recalibrate("camera_9").message,
              "no camera 'camera_9', and none of that name sends images: start its driver, or "
              "name one of camera_1, camera_2, camera_3, camera_4");
  putLed({1.0, 1.0, 1.0});
  EXPECT_FALSE(recalibrate("camera_2", 2.0).success);

  cameras_->waveLed(true);
  const auto response = recalibrate("camera_2");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_NEAR(response.moved, 0.05, 0.01);
  EXPECT_NEAR(response.turned, 0.05, 0.003);
  EXPECT_SAYS(response.message, "the masks of camera_2 cover where lamps were before: switch");
  Latest<RigCalibration> published("calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return published.get() && published.get()->id != rig.id(); }));
  const geometry::Rig result = fromMessage(*published.get());
  EXPECT_LT((result.cameras[1].camera.center() - cameras_->truth[1].center()).norm(), 0.01);
  EXPECT_TRUE(waitUntil([&] { return status_->get()->message == response.message; }));
}

TEST_F(EditRig, RemovesACameraAndAddsIt) {
  const auto rigOf = [](std::size_t cameras) {
    Latest<RigCalibration> published("calibration/rig");
    EXPECT_TRUE(
        waitUntil([&] { return published.get() && published.get()->cameras.size() == cameras; }));
    return fromMessage(*published.get());
  };
  geometry::Rig with_lamp = trueRig();
  with_lamp.cameras[0].masks = {{{1000.0, 20.0}, 5.0}};
  load(with_lamp);
  EXPECT_SAYS(remove("camera_9").message, "no camera 'camera_9': name one of");
  const auto removed = remove("camera_2");
  ASSERT_TRUE(removed.success) << removed.message;
  EXPECT_SAYS(removed.message, "camera_2 was removed");
  EXPECT_SAYS(removed.message, "camera_2_optical_frame stays in TF until all nodes are started");
  EXPECT_EQ(removed.message.find("linked"), std::string::npos) << removed.message;
  const geometry::Rig three = rigOf(3);
  EXPECT_EQ(three.cameras[1].camera.name, "camera_3");
  EXPECT_EQ(three.verdict.find("usable: camera_2 was removed"), 0u) << three.verdict;

  cameras_->waveLed(true);
  const auto response = recalibrate("camera_2");
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_SAYS(response.message, "camera_2 was added");
  EXPECT_SAYS(response.message, "it has no masks yet: switch the LED off, and learn the lights");
  EXPECT_EQ(response.moved, 0.0);
  const geometry::Rig rig = rigOf(4);
  EXPECT_EQ(rig.cameras[3].camera.identity, "00:1e:35:00:00:02");
  EXPECT_LT((rig.cameras[3].camera.center() - cameras_->truth[1].center()).norm(), 0.05);
  EXPECT_EQ(rig.covariance.rows(), 64);
  wiimote_tracker_msgs::SaveRig::Request save;
  save.path = folder_ + "/added.yaml";
  ASSERT_TRUE(call<wiimote_tracker_msgs::SaveRig>("calibration/save", save).success);
  EXPECT_EQ(geometry::readRigFile(save.path).id(), rig.id());
}

TEST_F(EditRig, RefusesBeforeTheWaveWhatNoWaveCanSolve) {
  geometry::Rig of_square = trueRig();
  for (geometry::RigCamera& camera : of_square.cameras) {
    camera.time_offset = std::numeric_limits<double>::quiet_NaN();
    camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
  }
  const char* const square_alone =
      "as after a calibration by the square alone, so that camera_4 cannot be solved against them: "
      "calibrate all cameras again, with a waved LED";
  load(of_square);
  EXPECT_SAYS(recalibrate("camera_4", kForEver).message, square_alone);
  load(recalibrate::withoutCamera(of_square, "camera_4"));
  EXPECT_SAYS(recalibrate("camera_4", kForEver).message, square_alone);
  geometry::Rig two = trueRig();
  two.cameras.resize(2);
  two.covariance.resize(0, 0);
  load(two);
  EXPECT_SAYS(recalibrate("camera_1", kForEver).message,
              "two others or more, but the rig has 1 beside camera_1: calibrate all cameras again");

  geometry::Rig absent = trueRig();
  absent.cameras[3].camera.name = "camera_8";
  load(absent);
  EXPECT_SAYS(recalibrate("camera_8", kForEver).message, "camera_8 sends no images: check its");
  absent.cameras[1].camera.name = "camera_7";
  absent.cameras[2].camera.name = "camera_6";
  load(absent);
  EXPECT_SAYS(recalibrate("camera_2", kForEver).message,
              "two of camera_1, camera_7, camera_6, camera_8 are to see the LED, too, but fewer "
              "send images: start their drivers");
}

TEST_F(EditRig, RefusesANewCameraWhoseNameClashesBeforeTheWave) {
  geometry::writeRigFile(trueRig(), folder_ + "/clash.yaml");
  const Process process("/clash", {"_rig_file:=" + folder_ + "/clash.yaml"});
  ASSERT_TRUE(
      ros::service::waitForService("/clash/calibration/recalibrate_camera", ros::Duration(60.0)));
  ros::Publisher camera =
      ros::NodeHandle().advertise<wiimote_tracker_msgs::IrBlobArray>("/clash/camera/1/ir_blobs", 1);
  wiimote_tracker_msgs::IrBlobArray image;
  image.width = 1024;
  image.height = 768;
  std::string message;
  EXPECT_TRUE(waitUntil([&] {
    image.header.stamp = image.arrival = ros::Time::now();
    camera.publish(image);
    message = recalibrate("camera/1", kForEver, "/clash/").message;
    return message.find("none of that name sends images") == std::string::npos;
  }));
  EXPECT_SAYS(message, "'camera/1' and 'camera_1', share the frame camera_1_optical_frame");
}

// The node in /few watches three of the four cameras.
TEST_F(EditRig, NamesTheParameterThatLeavesOutACamera) {
  const char* const left_out =
      "the parameter /few/calibration/cameras names /camera_1, /camera_2, /camera_3, but not "
      "/camera_4: correct the name, or add it there and start the calibration node again";
  LoadRig::Request file;
  file.path = folder_ + "/few.yaml";
  geometry::writeRigFile(withSlashes(), file.path);
  const auto loaded = call<LoadRig>("/few/calibration/load", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_SAYS(loaded.message, left_out);
  EXPECT_EQ(loaded.message.find("start their drivers"), std::string::npos) << loaded.message;
  Latest<CalibrationStatus> status("/few/calibration/status");
  EXPECT_TRUE(waitUntil([&] { return status.get() && status.get()->next_title == "No images"; }));
  EXPECT_SAYS(status.get()->next_sentence, left_out);
  EXPECT_SAYS(recalibrate("/camera_4", kForEver, "/few/").message, left_out);
  wiimote_tracker_msgs::StartCalibration::Request start;
  start.cameras = {"/camera_1", "/camera_4"};
  start.side_x = 2.5;
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartCalibration>("/few/calibration/start", start).message,
              left_out);
  wiimote_tracker_msgs::StartBoard::Request board;
  board.camera = "/camera_4";
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartBoard>("/few/calibration/board/start", board).message,
              left_out);
  putLed({1.0, 1.0, 1.0});
  cameras_->blind({"camera_1", "camera_2", "camera_3"});
  wiimote_tracker_msgs::CheckPlace::Request place;
  place.known = pointOf({1.0, 1.0, 1.0});
  place.duration = 1.0;
  const auto checked = call<wiimote_tracker_msgs::CheckPlace>("/few/calibration/check", place);
  EXPECT_SAYS(checked.message, left_out);
  EXPECT_EQ(checked.message.find("/camera_4 sends no images"), std::string::npos)
      << checked.message;

  geometry::Rig rig = withSlashes();
  rig.cameras[1].camera.name = "/camera_5";
  rig.cameras[2].camera.name = "/camera_6";
  geometry::writeRigFile(rig, file.path);
  ASSERT_TRUE(call<LoadRig>("/few/calibration/load", file).success);
  EXPECT_SAYS(recalibrate("/camera_2", kForEver, "/few/").message,
              "but not /camera_5, /camera_6, /camera_4: correct the name, or add it there");
}

TEST_F(EditRig, WarnsOfARemovalThatSplitsTheRig) {
  geometry::Rig rig = trueRig();
  linkByTheSecond(&rig);
  load(rig);
  EXPECT_SAYS(remove("camera_2").message,
              "camera_2 alone linked the views of camera_1 with those of camera_3, camera_4: an "
              "LED that goes from one to the other is lost on the way; add it again, or turn");
}

}  // namespace
}  // namespace wiimote_tracker
