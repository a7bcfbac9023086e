// Drives the calibration node like a person, with cameras that this test plays. More than 400
// lines, because one test goes on with the rig file of another.

#include "node_fixture.h"

#include <geometry_msgs/PolygonStamped.h>
#include <std_msgs/String.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/MeasureLength.h>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::CheckPlace;
using wiimote_tracker_msgs::MeasureLength;

TEST_F(Node, RequestsWithoutARigAreRefusedWithAdvice) {
  EXPECT_TRUE(status_->get()->rig_id.empty());
  EXPECT_EQ(status_->get()->step, CalibrationStatus::IDLE);
  EXPECT_EQ(status_->get()->header.frame_id, "world");
  const auto saved = call<SaveRig>("calibration/save");
  EXPECT_FALSE(saved.success);
  EXPECT_SAYS(saved.message, "no rig to save");
  const auto loaded = call<LoadRig>("calibration/load");
  EXPECT_FALSE(loaded.success);
  EXPECT_SAYS(loaded.message, folder_);
  EXPECT_SAYS(capture().message, "start one first");
  EXPECT_SAYS(call<std_srvs::Trigger>("calibration/undo").message, "no captured corner");
  EXPECT_EQ(status_->get()->next_request, "learn_masks");
  const Latest<std_msgs::String> sound("calibration/sound");
  EXPECT_TRUE(waitUntil([&] {
    call<std_srvs::Trigger>("calibration/undo");
    return sound.get() && sound.get()->data == "refused";
  }));
}

TEST_F(Node, TheWorldAndTheSquareAreShownBeforeACalibration) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  EXPECT_TRUE(
      waitUntil([&] { return buffer.canTransform("world", "world_square", ros::Time(0)); }));
  EXPECT_TRUE(start(2.5, 2.0).success);
  Latest<geometry_msgs::PolygonStamped> square("calibration/square");
  EXPECT_TRUE(waitUntil([&] { return square.get() && square.get()->polygon.points.size() == 4; }));
}

TEST_F(Node, WithoutMasksTheLightsAreToBeLearnedAgain) {
  call<std_srvs::Trigger>("calibration/cancel");  // of the test before
  putLed(kCorners[0]);
  ASSERT_TRUE(waitUntil([] {
    call<CheckConnection>("calibration/check_connection");
    return status_->get()->next_request == "start";
  }));
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/clear_masks").success);
  EXPECT_TRUE(waitUntil([] { return status_->get()->next_request == "learn_masks"; }));
}

TEST_F(Node, TheConnectionCheckNamesTheCamerasThatFail) {
  call<std_srvs::Trigger>("calibration/cancel");  // a walk comes before the start
  putLed(kCorners[0]);
  CheckConnection::Request request;
  request.duration = 0.3;
  const auto check = [&] { return call<CheckConnection>("calibration/check_connection", request); };
  CheckConnection::Response response;
  ASSERT_TRUE(waitUntil([&] {  // a busy computer may send no images for that time
    response = check();
    return response.success && response.cameras.size() == 4 && response.cameras[1].rate > 10.0;
  })) << response.message;
  EXPECT_EQ(response.cameras[1].name, "camera_2");
  EXPECT_EQ(response.cameras[1].identity, "00:1e:35:00:00:02");
  EXPECT_TRUE(response.cameras[1].sees_led);
  boost::shared_ptr<const CalibrationStatus> walked;
  EXPECT_TRUE(waitUntil([&] {
    walked = status_->get();
    return walked->cameras[1].seen_with.size() == 3 && !walked->walk.empty();
  }));
  EXPECT_GT(walked->cameras[1].seen_share, 0.0);
  EXPECT_SAYS(walked->walk, "the LED was seen: camera_1");

  cameras_->blind({"camera_3"});
  EXPECT_TRUE(waitUntil([&] {
    response = check();
    return !response.success && response.cameras[2].blobs == 0 &&
           response.message.find("camera_3 sees no spot") != std::string::npos &&
           response.message.find("camera_2") == std::string::npos;
  })) << response.message;
  request.duration = 0.001;  // shorter than one image takes
  EXPECT_SAYS(check().message, "0.05 and 10 s");
}

TEST_F(Node, SidesMustBeLengths) {
  const auto zero = start(0.0);
  EXPECT_FALSE(zero.success);
  EXPECT_SAYS(zero.message, "side_length");
  for (const double side : {-1.0, std::nan("")})
    EXPECT_FALSE(start(side).success);
  EXPECT_FALSE(start(1.0, -1.0).success);
  EXPECT_FALSE(start(0.0, 1.0).success);
  EXPECT_TRUE(waitUntil([] { return status_->get()->message.find("side") != std::string::npos; }));
  wiimote_tracker_msgs::StartCalibration::Request request;
  request.side_x = 1.0;
  request.cameras = {"camera_1", "camera_9"};
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request).message,
              "there is no camera 'camera_9'");
}

TEST_F(Node, BadInputBetweenStepsLosesNothing) {
  const auto started = start(2.5, 2.0);
  ASSERT_TRUE(started.success) << started.message;
  EXPECT_TRUE(waitForStep(CalibrationStatus::READY));
  EXPECT_EQ(status_->get()->square_sides, std::vector<double>({2.5, 2.0}));
  putLed(kCorners[0]);
  auto result = captureByAll();
  EXPECT_TRUE(result.success) << result.message;
  EXPECT_EQ(result.corner, 0U);
  ASSERT_EQ(result.cameras.size(), 4U);
  EXPECT_GE(result.cameras[0].samples.at(0), 20U);
  EXPECT_LT(result.cameras[0].spread.at(0), 1.0);
  EXPECT_NEAR(result.cameras[0].corner_x.at(0), result.cameras[0].x, 2.0);
  EXPECT_NEAR(result.cameras[0].corner_y.at(0), result.cameras[0].y, 2.0);

  // The LED moves while it is captured.
  putLed(kCorners[1]);
  cameras_->putLed(kCorners[1], 0.5);
  result = capture();
  EXPECT_FALSE(result.success);
  EXPECT_SAYS(result.message, "the LED moved");
  EXPECT_EQ(capture_->getState(), actionlib::SimpleClientGoalState::ABORTED);

  const auto early = call<SolveCalibration>("calibration/solve");
  EXPECT_FALSE(early.success);
  EXPECT_SAYS(early.message, "only 1 of 4 corners");
  EXPECT_TRUE(early.rig.cameras.empty());

  // A corner that one camera does not see.
  putLed(kCorners[1]);
  cameras_->blind({"camera_2"});
  EXPECT_TRUE(waitUntil([&] {
    CheckConnection::Request request;
    request.duration = 0.05;
    return call<CheckConnection>("calibration/check_connection", request).cameras[1].blobs == 0;
  }));
  result = capture();
  EXPECT_TRUE(result.success) << result.message;
  EXPECT_SAYS(result.message, "camera_2 sees no spot");
  EXPECT_EQ(result.cameras[1].samples, std::vector<std::uint32_t>({20, 0}));

  // Undo, and nobody sees the LED until the time is up.
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/undo").success);
  cameras_->blind({"camera_1", "camera_2", "camera_3", "camera_4"});
  EXPECT_TRUE(waitUntil([] {
    const auto status = status_->get();
    for (const auto& camera : status->cameras) {
      if (camera.blobs != 0)
        return false;
    }
    return true;
  }));
  result = capture();
  EXPECT_FALSE(result.success);
  EXPECT_SAYS(result.message, "0 of at least 2 cameras");
  EXPECT_TRUE(waitUntil([] { return status_->get()->corners_captured == 1; }));

  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
}

TEST_F(Node, ACaptureCanBePreemptedAndCancelled) {
  ASSERT_TRUE(start(2.5).success);
  cameras_->blind({"camera_1", "camera_2", "camera_3", "camera_4"});
  capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
  EXPECT_TRUE(waitForStep(CalibrationStatus::CAPTURING));
  capture_->cancelGoal();
  EXPECT_TRUE(capture_->waitForResult(ros::Duration(kPatience)));
  EXPECT_EQ(capture_->getState(), actionlib::SimpleClientGoalState::PREEMPTED);
  EXPECT_TRUE(waitForStep(CalibrationStatus::READY));

  capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
  EXPECT_TRUE(waitForStep(CalibrationStatus::CAPTURING));
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(capture_->waitForResult(ros::Duration(kPatience)));
  EXPECT_FALSE(capture_->getResult()->success);
  EXPECT_SAYS(capture_->getResult()->message, "it was cancelled");
  EXPECT_TRUE(waitForStep(CalibrationStatus::READY));  // the run goes on
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
}

TEST_F(Node, ACaptureThatAnotherOneReplacesSaysSo) {
  Client other("calibration/capture_corner", true);
  ASSERT_TRUE(other.waitForServer(ros::Duration(kPatience)));
  ASSERT_TRUE(start(2.5).success);
  cameras_->blind({"camera_1", "camera_2", "camera_3", "camera_4"});
  other.sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
  EXPECT_TRUE(waitForStep(CalibrationStatus::CAPTURING));
  capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
  ASSERT_TRUE(other.waitForResult(ros::Duration(kPatience)));
  EXPECT_SAYS(other.getResult()->message, "another request to capture a corner came");
  capture_->cancelGoal();
  ASSERT_TRUE(capture_->waitForResult(ros::Duration(kPatience)));
  EXPECT_SAYS(capture_->getResult()->message, "the request was cancelled");
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
}

/// actionlib then throws, or refuses all goals up to that year.
TEST_F(Node, ACaptureIsPossibleAfterACancellationFromTheYear2106) {
  ros::NodeHandle nh;
  const ros::Publisher cancel =
      nh.advertise<actionlib_msgs::GoalID>("calibration/capture_corner/cancel", 10);
  ASSERT_TRUE(waitUntil([&] { return cancel.getNumSubscribers() > 0; }));
  ASSERT_TRUE(start(2.5).success);
  for (const char* id : {"", "unknown"}) {
    cameras_->blind({"camera_1", "camera_2", "camera_3", "camera_4"});
    capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
    EXPECT_TRUE(waitForStep(CalibrationStatus::CAPTURING));
    actionlib_msgs::GoalID late;
    late.id = id;
    late.stamp = ros::TIME_MAX;
    cancel.publish(late);
    for (int i = 0; i < 20; ++i) {  // goals while the server starts anew
      capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
      cancel.publish(late);
    }
    EXPECT_TRUE(waitForStep(CalibrationStatus::READY)) << "the run goes on";
    cameras_->blind({});
    putLed(kCorners[0]);
    EXPECT_TRUE(waitUntil([&] {
      capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
      capture_->waitForResult(ros::Duration(5.0));
      return status_->get()->corners_captured == 1;
    }));
    EXPECT_TRUE(call<std_srvs::Trigger>("calibration/undo").success);
    EXPECT_TRUE(waitUntil([] { return status_->get()->corners_captured == 0; }));
  }
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
}

TEST_F(Node, FourCornersAreSolvedSavedAndLoaded) {
  captureAll();
  EXPECT_TRUE(waitForStep(CalibrationStatus::COMPLETE));
  MeasureLength::Request length;
  length.to_corner = 2;
  length.length = 2.5;
  EXPECT_SAYS(call<MeasureLength>("calibration/measure_length", length).message,
              "corner 1 to corner 3 is 3.536 m by the sides");
  length.length = 3.5355;
  EXPECT_TRUE(call<MeasureLength>("calibration/measure_length", length).success);
  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  ASSERT_EQ(solved.rig.cameras.size(), 4U);
  EXPECT_EQ(solved.rig.square_sides, std::vector<double>({2.5, 2.5}));
  EXPECT_EQ(solved.rig.ray_model, RigCalibration::RAY_MODEL_CALIBRATED);
  EXPECT_EQ(solved.rig.covariance.size(), 64U * 64U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d center = vectorOf(solved.rig.cameras[i].world_from_camera.position);
    // 0.1 px, averaged over twenty images, at 6 m.
    EXPECT_LT((center - cameras_->truth[i].center()).norm(), 0.03);
    EXPECT_EQ(solved.rig.cameras[i].identity, "00:1e:35:00:00:0" + std::to_string(i + 1));
    EXPECT_LT(solved.rig.cameras[i].residual_px, 0.2);
    EXPECT_LT(solved.rig.cameras[i].residual_m, 0.001);
  }
  ASSERT_EQ(solved.rig.cameras[0].gravity.size(), 3U);
  const Eigen::Vector3d up = cameras_->truth[0].world_from_camera.linear().row(2);
  EXPECT_LT((Eigen::Vector3d(solved.rig.cameras[0].gravity.data()) - 9.81 * up).norm(), 1e-6);
  EXPECT_TRUE(solved.rig.cameras[1].gravity.empty());
  EXPECT_TRUE(waitForStep(CalibrationStatus::SOLVED));

  // Others hear of it, also those who come later.
  Latest<RigCalibration> rig("calibration/rig");
  ASSERT_TRUE(waitUntil([&] { return rig.get() && rig.get()->id == solved.rig.id; }));
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string frame = cameras_->truth[i].name + "_optical_frame";
    ASSERT_TRUE(waitUntil([&] { return buffer.canTransform("world", frame, ros::Time(0)); }));
    const Eigen::Isometry3d world_from_camera =
        tf2::transformToEigen(buffer.lookupTransform("world", frame, ros::Time(0)));
    EXPECT_LT((world_from_camera.translation() - cameras_->truth[i].center()).norm(), 0.03);
    EXPECT_LT(square::rotationBetween(world_from_camera, cameras_->truth[i].world_from_camera),
              0.01);
  }

  // The verdict of the node comes to all as well.
  Latest<wiimote_tracker_msgs::CalibrationVerdict> verdict("calibration/verdict");
  ASSERT_TRUE(waitUntil([&] { return verdict.get() != nullptr; }));
  EXPECT_EQ(verdict.get()->rig_id, solved.rig.id);
  EXPECT_EQ(verdict.get()->text, solved.verdict.text);
  EXPECT_FALSE(solved.verdict.text.empty());
  EXPECT_EQ(verdict.get()->cameras.size(), 4U);
  EXPECT_EQ(verdict.get()->predicted_stddev.size(), 8U);

  // Saving writes the rig, a file per camera, and tells the drivers.
  const auto saved = call<SaveRig>("calibration/save");
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.path, folder_ + "/rig.yaml");
  EXPECT_SAYS(saved.message, "nothing offers set_camera_info of camera_4:");
  EXPECT_EQ(saved.message.find("camera_1"), std::string::npos) << saved.message;
  EXPECT_EQ(geometry::readRigFile(saved.path).id(), solved.rig.id);
  for (const geometry::Camera& camera : cameras_->truth)
    EXPECT_TRUE(exists(folder_ + "/" + camera.name + ".yaml"));
  const auto infos = cameras_->cameraInfos();
  ASSERT_EQ(infos.size(), 3U);
  EXPECT_EQ(infos.at("camera_2").K[0], solved.rig.cameras[1].fx);
  EXPECT_EQ(infos.at("camera_2").K[5], solved.rig.cameras[1].cy);
  EXPECT_EQ(infos.at("camera_2").D, solved.rig.cameras[1].distortion);
  EXPECT_EQ(infos.at("camera_2").width, 1024U);
  EXPECT_TRUE(waitForStep(CalibrationStatus::SAVED));
  EXPECT_TRUE(call<SaveRig>("calibration/save").success);
  EXPECT_TRUE(exists(folder_ + "/rig.yaml.bak"));

  // A file cut in two is refused, and the rig stays.
  const std::string text = contents(saved.path);
  const std::string half = folder_ + "/half.yaml";
  std::ofstream(half) << text.substr(0, text.size() / 2);
  LoadRig::Request request;
  request.path = half;
  const auto refused = call<LoadRig>("calibration/load", request);
  EXPECT_FALSE(refused.success);
  EXPECT_SAYS(refused.message, half);
  EXPECT_EQ(rig.get()->id, solved.rig.id);
  EXPECT_EQ(status_->get()->rig_id, solved.rig.id);

  // A folder that cannot be written is refused too.
  SaveRig::Request elsewhere;
  elsewhere.path = folder_ + "/rig.yaml/below_a_file.yaml";
  EXPECT_FALSE(call<SaveRig>("calibration/save", elsewhere).success);

  // So are files outside of the folder, also behind a link.
  EXPECT_EQ(std::system(("ln -s /tmp '" + folder_ + "/link'").c_str()), 0);
  const std::string outside = folder_ + "x.yaml";  // by three ways
  const std::string name = outside.substr(outside.rfind('/'));
  for (const std::string& path :
       {outside, folder_ + "/.." + name, folder_ + "/link" + name, std::string("/etc/hostname")}) {
    elsewhere.path = request.path = path;
    EXPECT_SAYS(call<SaveRig>("calibration/save", elsewhere).message, "file_folder");
    EXPECT_SAYS(call<LoadRig>("calibration/load", request).message, "file_folder");
  }
  EXPECT_FALSE(exists(outside));

  // Bytes that are no text are not repeated.
  elsewhere.path = request.path = folder_ + "/\xff\xc3.yaml";
  const std::string no_text = "the path is not UTF-8: choose another name for the file";
  EXPECT_EQ(call<SaveRig>("calibration/save", elsewhere).message, no_text);
  EXPECT_EQ(call<LoadRig>("calibration/load", request).message, no_text);

  const auto loaded = call<LoadRig>("calibration/load");
  EXPECT_TRUE(loaded.success) << loaded.message;
  EXPECT_SAYS(loaded.message, solved.rig.id);

  // A known place makes the next solution more accurate, as its verdict promised.
  const Eigen::Vector3d place(1.0, 0.8, 1.5);
  putLed(place);
  CheckPlace::Request known;
  known.known = pointOf(place + Eigen::Vector3d(1.0, 0.0, 0.0));
  EXPECT_SAYS(call<CheckPlace>("calibration/measure_place", known).message, "from the known place");
  known.known_stddev = -1.0;
  EXPECT_SAYS(call<CheckPlace>("calibration/measure_place", known).message, "known_stddev");
  known = CheckPlace::Request();
  known.known = pointOf(place);
  const auto placed = call<CheckPlace>("calibration/measure_place", known);
  ASSERT_TRUE(placed.success) << placed.message;
  EXPECT_SAYS(placed.message, "place 1 at (1.000, 0.800, 1.500) m is captured by 4 cameras");
  EXPECT_TRUE(waitForStep(CalibrationStatus::COMPLETE));
  EXPECT_SAYS(call<SaveRig>("calibration/save").message, "calibration under way is not in it");
  const auto again = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(again.success) << again.message;
  EXPECT_SAYS(solved.verdict.next_measurement, "put the LED on a place you know");
  EXPECT_LT(solved.verdict.next_expected_error, 0.95 * solved.verdict.expected_error);
  EXPECT_LT(again.verdict.expected_error, 0.95 * solved.verdict.expected_error);
}

TEST_F(Node, TheLastSavedRigIsLoadedAtStart) {
  ASSERT_TRUE(exists(folder_ + "/rig.yaml"));  // from the test before
  const Process process("/stored", {"_rig_file:=" + folder_ + "/rig.yaml", "_origin_x:=1.0",
                                    "_world_frame:=elsewhere"});
  Latest<RigCalibration> rig("/stored/calibration/rig");
  Latest<geometry_msgs::PolygonStamped> square("/stored/calibration/square");
  Latest<CalibrationStatus> status("/stored/calibration/status");
  ASSERT_TRUE(waitUntil([&] { return rig.get() && status.get(); }));
  EXPECT_EQ(rig.get()->id, geometry::readRigFile(folder_ + "/rig.yaml").id());
  EXPECT_EQ(status.get()->step, CalibrationStatus::SAVED);
  ASSERT_TRUE(waitUntil([&] { return square.get() && !square.get()->polygon.points.empty(); }));
  EXPECT_EQ(square.get()->header.frame_id, "world");
  EXPECT_EQ(square.get()->polygon.points[0].x, 0.0f) << "where it was calibrated, with origin_x: 0";
}

TEST_F(Node, ADamagedRigAtStartDoesNotStopTheNode) {
  ASSERT_TRUE(exists(folder_ + "/half.yaml"));  // from the test before
  const Process process("/damaged", {"_rig_file:=" + folder_ + "/half.yaml"});
  Latest<CalibrationStatus> status("/damaged/calibration/status");
  ASSERT_TRUE(waitUntil([&] { return status.get() != nullptr; }));
  EXPECT_EQ(status.get()->step, CalibrationStatus::IDLE);
  EXPECT_SAYS(status.get()->message, "half.yaml");
  EXPECT_TRUE(status.get()->rig_id.empty());
  EXPECT_TRUE(waitForDiagnosis("half.yaml"));
}

TEST_F(Node, ALoadedRigOfCamerasWithoutImagesIsNamed) {
  ASSERT_TRUE(exists(folder_ + "/rig.yaml"));  // from a test before
  const Process process("/silent", {"_rig_file:=" + folder_ + "/none.yaml"});
  LoadRig::Request request;
  request.path = folder_ + "/rig.yaml";
  ASSERT_TRUE(ros::service::waitForService("/silent/calibration/load", ros::Duration(60.0)));
  EXPECT_TRUE(waitForDiagnosis("none.yaml, so the start is without a rig"));
  const auto loaded = call<LoadRig>("/silent/calibration/load", request);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_SAYS(loaded.message, "no image has come yet from ");
  Latest<CalibrationStatus> status("/silent/calibration/status");
  EXPECT_TRUE(waitUntil([&] { return status.get() && status.get()->next_title == "No images"; }));
  EXPECT_SAYS(status.get()->next_sentence, "no image has come yet from camera_1, camera_2, ");
  EXPECT_EQ(call<LoadRig>("calibration/load").message.find("no image has come"), std::string::npos);
}

TEST_F(Node, CamerasOfATrackerInANamespaceBelowAreNotItsOwn) {
  const Process process("/second", {"_rig_file:=" + folder_ + "/none.yaml"});
  Latest<CalibrationStatus> second("/second/calibration/status");
  ASSERT_TRUE(waitUntil([&] { return second.get() != nullptr; }));
  const ros::Publisher camera = ros::NodeHandle().advertise<wiimote_tracker_msgs::IrBlobArray>(
      "/second/camera_9/ir_blobs", 1);
  ASSERT_TRUE(waitUntil([&] { return second.get()->cameras.size() == 1; }));
  EXPECT_EQ(second.get()->cameras[0].name, "camera_9");
  const auto before = status_->get()->header.seq;
  ASSERT_TRUE(waitUntil([&] { return status_->get()->header.seq > before + 4; }));
  EXPECT_EQ(status_->get()->cameras.size(), 4u);
}

TEST_F(Node, ItLeavesCamerasToATrackerThatIsStartedAfterTheirDrivers) {
  ros::Publisher camera =
      ros::NodeHandle().advertise<wiimote_tracker_msgs::IrBlobArray>("/third/camera_8/ir_blobs", 1);
  ASSERT_TRUE(waitUntil([] { return status_->get()->cameras.size() == 5; }));
  const Process process("/third", {"_rig_file:=" + folder_ + "/none.yaml"});
  EXPECT_TRUE(waitUntil([] { return status_->get()->cameras.size() == 4; }));
  camera.shutdown();  // before the other tracker, else it would be found again
}

TEST_F(Node, WithARigInUseTheConnectionCheckBeginsTheWalk) {
  ASSERT_FALSE(status_->get()->rig_id.empty());  // from a test before
  EXPECT_TRUE(waitUntil([] {
    call<std_srvs::Trigger>("calibration/cancel");
    return status_->get()->step == CalibrationStatus::IDLE;
  }));
  EXPECT_EQ(status_->get()->walk, "");
  putLed(kCorners[0]);
  CheckConnection::Request request;
  request.duration = 0.3;
  call<CheckConnection>("calibration/check_connection", request);
  EXPECT_TRUE(waitUntil([] { return !status_->get()->walk.empty(); }));
}

}  // namespace
}  // namespace wiimote_tracker
