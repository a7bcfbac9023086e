// What was captured goes through a file and is solved again; a solver that runs is cancelled; two
// rooms come into one world. With cameras that this test plays.

#include "node_fixture.h"
#include "run_command.h"

#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/JoinRig.h>
#include <wiimote_tracker_msgs/LoadSamples.h>
#include <wiimote_tracker_msgs/SaveSamples.h>
#include <wiimote_tracker_msgs/StartWave.h>

#include <future>

namespace wiimote_tracker {
namespace {

using std_srvs::Trigger;
using wiimote_tracker_msgs::AddKnownPlace;
using wiimote_tracker_msgs::JoinRig;
using wiimote_tracker_msgs::LoadSamples;
using wiimote_tracker_msgs::SaveSamples;

class Samples : public Node {
 protected:
  /// The square and a wave, from messages.
  static void captureSquareAndWave() {
    captureAll();
    cameras_->waveLed(true);
    ASSERT_TRUE(call<wiimote_tracker_msgs::StartWave>("calibration/start_wave").success);
    ASSERT_TRUE(waitForStep(CalibrationStatus::WAVING));
    ASSERT_TRUE(waitUntil([] { return status_->get()->missing.empty(); }));
    const auto stopped = call<Trigger>("calibration/stop_wave");
    ASSERT_TRUE(stopped.success) << stopped.message;
    cameras_->waveLed(false);
  }

  static SaveSamples::Response save(const std::string& path) {
    SaveSamples::Request request;
    request.path = path;
    return call<SaveSamples>("calibration/save_samples", request);
  }

  static LoadSamples::Response load(const std::string& node, const std::string& path) {
    LoadSamples::Request request;
    request.path = path;
    return call<LoadSamples>(node + "calibration/load_samples", request);
  }

  /// Nothing is captured.
  static void clear() {
    ASSERT_TRUE(waitUntil([] {
      call<Trigger>("calibration/cancel");
      return status_->get()->step == CalibrationStatus::IDLE;
    }));
  }

  /// The square and a wave, from the file of an earlier test if there is one.
  static void loadSquareAndWave() {
    if (!std::ifstream(folder_ + "/samples.yaml")) {
      captureSquareAndWave();
      ASSERT_TRUE(save("").success);
    }
    ASSERT_TRUE(load("", "").success);
  }
};

TEST_F(Samples, NothingToSaveIsRefusedAndAFailedLoadChangesNothing) {
  EXPECT_SAYS(save("").message, "nothing was captured");
  EXPECT_SAYS(load("", "").message, folder_ + "/samples.yaml");
  ASSERT_TRUE(start(2.5).success);
  EXPECT_SAYS(save("").message, "nothing was captured");
  EXPECT_FALSE(std::ifstream(folder_ + "/samples.yaml")) << "nor was a file replaced";
  putLed(kCorners[0]);
  ASSERT_TRUE(capture().success);
  EXPECT_EQ(std::system(("mkdir -p '" + folder_ + "'").c_str()), 0);
  std::ofstream(folder_ + "/broken.yaml") << "format: [";
  EXPECT_FALSE(load("", folder_ + "/broken.yaml").success);
  EXPECT_TRUE(
      waitUntil([] { return status_->get()->message.find("broken") != std::string::npos; }));
  EXPECT_EQ(status_->get()->corners_captured, 1U);
  // Half a square is worth keeping, too.
  ASSERT_TRUE(save(folder_ + "/half.yaml").success);
  clear();
  const auto loaded = load("", folder_ + "/half.yaml");
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_TRUE(waitUntil([] { return status_->get()->corners_captured == 1; }));
  putLed(kCorners[1]);
  const auto captured = capture();
  EXPECT_TRUE(captured.success) << captured.message;
  EXPECT_EQ(captured.corner, 1U);
}

TEST_F(Samples, SolvedAgainTheyGiveTheIdenticalRig) {
  captureSquareAndWave();
  const auto live = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(live.success) << live.message;
  EXPECT_SAYS(live.rig.method, "wave");
  const auto saved = save("");
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.path, folder_ + "/samples.yaml");

  // In the same node, after all was dropped.
  clear();
  EXPECT_FALSE(call<SolveCalibration>("calibration/solve").success);
  const auto loaded = load("", "");
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_TRUE(waitForStep(CalibrationStatus::COMPLETE));
  const auto again = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(again.success) << again.message;
  EXPECT_EQ(again.rig.id, live.rig.id);
  EXPECT_EQ(again.rig.covariance, live.rig.covariance);
  EXPECT_EQ(again.verdict.text, live.verdict.text);
  // Saved once more it is the same file.
  ASSERT_TRUE(save(folder_ + "/again.yaml").success);
  EXPECT_EQ(contents(folder_ + "/again.yaml"), contents(saved.path));
}

/// Exit status and what it says, of the program that solves without the node.
std::pair<int, std::string> solveSamples(const std::string& arguments) {
  return runCommand("rosrun wiimote_tracker_calibration solve_samples " + arguments);
}

TEST_F(Samples, AreSolvedWithoutTheNodeByItsParameters) {
  loadSquareAndWave();
  const auto live = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(live.success) << live.message;
  const std::string samples = "'" + folder_ + "/samples.yaml' --params '" + folder_;
  // This node's parameters are not the default ones.
  std::ofstream(folder_ + "/parameters.yaml")
      << "calibration: {stamp_wander: 0.0002, side_length: 2.5}\n"
         "triangulation: {mode: instant}\n";
  auto outcome = solveSamples(samples + "/parameters.yaml' --rig '" + folder_ + "/offline.yaml'");
  EXPECT_EQ(outcome.first, 0);
  EXPECT_SAYS(outcome.second, "rig " + live.rig.id);
  EXPECT_EQ(geometry::readRigFile(folder_ + "/offline.yaml").id(), live.rig.id);
  outcome = solveSamples("'" + folder_ + "/samples.yaml'");
  EXPECT_EQ(outcome.first, 0);
  EXPECT_EQ(outcome.second.find("rig " + live.rig.id), std::string::npos);

  std::ofstream(folder_ + "/misspelt.yaml") << "stamp_wonder: 0.0002\n";
  outcome = solveSamples(samples + "/misspelt.yaml'");
  EXPECT_EQ(outcome.first, 1);
  EXPECT_SAYS(outcome.second, "misspelt.yaml/stamp_wonder");
  std::ofstream(folder_ + "/wrong.yaml") << "stamp_wander: a little\n";
  outcome = solveSamples(samples + "/wrong.yaml'");
  EXPECT_EQ(outcome.first, 1);
  EXPECT_SAYS(outcome.second, "wrong.yaml/stamp_wander has the wrong type");
  EXPECT_EQ(solveSamples(samples + "/absent.yaml'").first, 1);
}

TEST_F(Samples, ACancelledSolverStopsAndNothingIsLost) {
  loadSquareAndWave();
  // Whoever is too late to stop the solver loses nothing either, and may try again.
  SolveCalibration::Response response;
  ASSERT_TRUE(waitUntil([&] {
    EXPECT_TRUE(waitForStatus()) << "that no solver runs";
    auto solving =
        std::async(std::launch::async, [] { return call<SolveCalibration>("calibration/solve"); });
    waitUntil([&] {
      return status_->get()->step == CalibrationStatus::SOLVING ||
             solving.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    EXPECT_TRUE(call<Trigger>("calibration/cancel").success);
    response = solving.get();
    return !response.success;
  }));
  EXPECT_SAYS(response.message, "cancelled; what was captured stays");
  EXPECT_TRUE(response.rig.cameras.empty());
  EXPECT_TRUE(waitForStep(CalibrationStatus::COMPLETE));
  EXPECT_EQ(status_->get()->next_request, "solve");
  EXPECT_EQ(status_->get()->corners_captured, 4U);
  EXPECT_GT(status_->get()->wave_seconds, 2.0);

  // A cancel a moment after the solver has finished.
  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  EXPECT_SAYS(call<Trigger>("calibration/cancel").message, "nothing was dropped");
  EXPECT_TRUE(waitForStep(CalibrationStatus::SOLVED));
  EXPECT_EQ(status_->get()->corners_captured, 4U);
  EXPECT_EQ(status_->get()->rig_id, solved.rig.id);
  // One more is meant.
  EXPECT_TRUE(call<Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
  EXPECT_EQ(status_->get()->corners_captured, 0U);
  EXPECT_EQ(status_->get()->rig_id, solved.rig.id);
}

class Rooms : public Node {
 protected:
  /// Cameras of the true rig in the world `world`, each known to 1 mm and 1 mrad.
  static geometry::Rig room(const std::vector<std::size_t>& cameras,
                            const Eigen::Isometry3d& world) {
    geometry::Rig rig;
    for (const std::size_t i : cameras) {
      geometry::RigCamera camera;
      camera.camera = cameras_->truth[i];
      camera.camera.world_from_camera = world.inverse() * camera.camera.world_from_camera;
      camera.time_offset = 0.0;
      camera.time_offset_rule = geometry::TimeOffsetRule::kAlways;
      rig.cameras.push_back(camera);
    }
    const auto size = static_cast<Eigen::Index>(16 * cameras.size());
    rig.covariance = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index at = 0; at < size; at += 16)
      rig.covariance.diagonal().segment<6>(at).setConstant(1e-6);
    rig.method = "test";
    return rig;
  }

  static Eigen::Isometry3d secondWorld() {
    Eigen::Isometry3d world = Eigen::Isometry3d::Identity();
    world.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    world.translation() = Eigen::Vector3d(3.0, -1.0, 0.2);
    return world;
  }

  static void use(const geometry::Rig& rig) {
    LoadRig::Request request;
    request.path = folder_ + "/second.yaml";
    EXPECT_EQ(std::system(("mkdir -p '" + folder_ + "'").c_str()), 0);
    geometry::writeRigFile(rig, request.path);
    const auto response = call<LoadRig>("calibration/load", request);
    ASSERT_TRUE(response.success) << response.message;
  }

  static JoinRig::Response join(const std::string& file) {
    JoinRig::Request request;
    request.path = folder_ + "/" + file;
    return call<JoinRig>("calibration/join", request);
  }

  static void expectTruth(const wiimote_tracker_msgs::RigCalibration& message, double tolerance) {
    const geometry::Rig rig = fromMessage(message);
    ASSERT_EQ(rig.cameras.size(), 4U);
    for (const geometry::Camera& truth : cameras_->truth)
      EXPECT_LT((rig.find(truth.name)->camera.center() - truth.center()).norm(), tolerance)
          << truth.name;
  }
};

TEST_F(Rooms, OfAnotherFileAreNotLoadedAtTheNextStart) {
  geometry::Rig rig = room({0, 1}, Eigen::Isometry3d::Identity());
  rig.cameras[0].camera.intrinsics.fx += 1.0;
  use(rig);
  const auto lens_is_sent = [&] {
    auto infos = cameras_->cameraInfos();
    return infos["camera_1"].K[0] == rig.cameras[0].camera.intrinsics.fx;
  };
  const std::string none = "; the next start is without a rig: save without a name, too";
  const std::string note =
      "; the next start loads " + folder_ +
      "/rig.yaml, and drivers and camera files keep its lenses: save without a name";
  LoadRig::Request load;
  load.path = "second.yaml";
  EXPECT_SAYS(call<LoadRig>("calibration/load", load).message, none);
  SaveRig::Request save;
  save.path = "third.yaml";
  EXPECT_SAYS(call<SaveRig>("calibration/save", save).message, none);
  EXPECT_FALSE(lens_is_sent());
  // By a link, and before it is there.
  EXPECT_FALSE(exists(folder_ + "/rig.yaml"));
  EXPECT_EQ(symlink(".", (folder_ + "/link").c_str()), 0);
  save.path = "link/rig.yaml";
  load.path = "rig.yaml";
  const std::string next = "the next start";
  EXPECT_EQ(call<SaveRig>("calibration/save", save).message.find(next), std::string::npos);
  EXPECT_TRUE(lens_is_sent());
  EXPECT_EQ(call<LoadRig>("calibration/load", load).message.find(next), std::string::npos);
  // Now that it is there.
  load.path = "second.yaml";
  EXPECT_SAYS(call<LoadRig>("calibration/load", load).message, note);
  save.path = "third.yaml";
  EXPECT_SAYS(call<SaveRig>("calibration/save", save).message, note);
  EXPECT_EQ(std::remove((folder_ + "/rig.yaml").c_str()), 0);
}

TEST_F(Rooms, OfTwoNodesWithOneFileAreNotReplacedWithoutAWord) {
  use(room({0, 1}, Eigen::Isometry3d::Identity()));
  SaveRig::Request save;
  save.path = "shared.yaml";
  ASSERT_TRUE(call<SaveRig>("calibration/save", save).success);
  const Process other("/other", {"_rig_file:=" + folder_ + "/shared.yaml"});
  ASSERT_TRUE(ros::service::waitForService("/other/calibration/save", ros::Duration(60.0)));
  const geometry::Rig newer = room({1, 2, 3}, Eigen::Isometry3d::Identity());
  use(newer);
  EXPECT_TRUE(call<SaveRig>("calibration/save", save).success) << "the node has saved it before";

  const auto refused = call<SaveRig>("/other/calibration/save");
  EXPECT_FALSE(refused.success);
  EXPECT_SAYS(refused.message, "shared.yaml holds a rig of camera_2, camera_3, camera_4 that this");
  EXPECT_EQ(geometry::readRigFile(folder_ + "/shared.yaml").id(), newer.id());
  EXPECT_TRUE(call<SaveRig>("/other/calibration/save").success);
  EXPECT_FALSE(call<SaveRig>("calibration/save", save).success);
  save.path = "elsewhere.yaml";
  EXPECT_TRUE(call<SaveRig>("calibration/save", save).success);
}

TEST_F(Rooms, HaveTheWorldFrameOfTheirFile) {
  geometry::Rig rig = room({0, 1}, Eigen::Isometry3d::Identity());
  rig.world_frame = "map";
  use(rig);
  LoadRig::Request load;
  load.path = "second.yaml";
  EXPECT_SAYS(call<LoadRig>("calibration/load", load).message,
              "its world frame is map: calibrate again to have world,");
  rig.world_frame = "world";
  use(rig);
  EXPECT_EQ(call<LoadRig>("calibration/load", load).message.find("world frame"), std::string::npos);
}

TEST_F(Rooms, AreJoinedOverTheCamerasThatTheyShare) {
  use(room({2, 3}, secondWorld()));
  geometry::writeRigFile(room({0, 1, 2}, Eigen::Isometry3d::Identity()), folder_ + "/first.yaml");
  EXPECT_SAYS(join("missing.yaml").message, "missing.yaml");
  EXPECT_SAYS(join("second.yaml").message, "the same rig");
  const auto joined = join("first.yaml");
  ASSERT_TRUE(joined.success) << joined.message;
  EXPECT_SAYS(joined.message, "over camera_3");
  expectTruth(joined.rig, 1e-6);
  Latest<RigCalibration> published("calibration/rig");
  EXPECT_TRUE(waitUntil([&] { return published.get() && published.get()->id == joined.rig.id; }));
  EXPECT_TRUE(waitUntil([&] { return status_->get()->rig_id == joined.rig.id; }));
  EXPECT_TRUE(waitForStep(CalibrationStatus::SOLVED));  // and not saved yet
}

TEST_F(Rooms, KeepTheMasksOfTheFirst) {
  use(room({2, 3}, secondWorld()));
  geometry::Rig first = room({0, 1, 2}, Eigen::Isometry3d::Identity());
  for (geometry::RigCamera& camera : first.cameras)
    camera.masks = {{{1000.0, 20.0}, 5.0}};
  geometry::writeRigFile(first, folder_ + "/first.yaml");
  const auto joined = join("first.yaml");
  ASSERT_TRUE(joined.success) << joined.message;
  EXPECT_EQ(joined.rig.cameras[0].masks.size(), 1U);
  // The images have them, too.
  EXPECT_TRUE(waitUntil([] {
    const auto status = status_->get();
    return status->cameras[0].masks == 1 && status->cameras[1].masks == 1 &&
           status->cameras[2].masks == 1 && status->cameras[3].masks == 0;
  }));
}

TEST_F(Rooms, WithoutASharedCameraAreJoinedOverKnownPlaces) {
  geometry::writeRigFile(room({0, 1}, Eigen::Isometry3d::Identity()), folder_ + "/first.yaml");
  use(room({2, 3}, secondWorld()));
  EXPECT_SAYS(join("first.yaml").message, "share no camera");
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0.4, 0.4, 0.1), Eigen::Vector3d(2.1, 0.4, 0.3),
        Eigen::Vector3d(2.1, 2.1, 0.1), Eigen::Vector3d(0.8, 1.9, 1.3)}) {
    putLed(place);
    AddKnownPlace::Request request;
    request.known = pointOf(place);
    const auto added = call<AddKnownPlace>("calibration/known_places/add", request);
    ASSERT_TRUE(added.success) << added.message;
    if (added.places < 3) {
      EXPECT_SAYS(join("first.yaml").message, "three or more");
    }
  }
  const auto joined = join("first.yaml");
  ASSERT_TRUE(joined.success) << joined.message;
  EXPECT_SAYS(joined.message, "over 4 common places");
  // Pixels of 0.1 px at 6 m, averaged over twenty images; the rooms' axes are held by places 2 m
  // apart, and the cameras stand 5 m away.
  expectTruth(joined.rig, 0.005);
  EXPECT_SAYS(call<Trigger>("calibration/known_places/undo").message,
              "dropped 4 places measured with another calibration");
  // A join that lacks them says so, too.
  use(room({2, 3}, secondWorld()));
  ASSERT_TRUE(call<AddKnownPlace>("calibration/known_places/add").success);
  use(room({2, 3}, Eigen::Isometry3d::Identity()));
  EXPECT_SAYS(join("first.yaml").message, "dropped 1 place measured with another calibration");
}

}  // namespace
}  // namespace wiimote_tracker
