// Waves and masks; hands-free capture, the button of a remote, and a bag.

#include "node_fixture.h"

#include <rosbag/bag.h>
#include <sensor_msgs/Joy.h>
#include <std_srvs/SetBool.h>
#include <wiimote_tracker_msgs/LearnMasks.h>
#include <wiimote_tracker_msgs/PrincipalPointTrace.h>
#include <wiimote_tracker_msgs/StartWave.h>
#include <wiimote_tracker_msgs/error.h>

#include <thread>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::StartWave;

class WavesAndMasks : public Node {
 protected:
  static std_srvs::SetBool::Response handsFree(const std::string& node, bool on) {
    std_srvs::SetBool::Request request;
    request.data = on;
    return call<std_srvs::SetBool>(node + "calibration/hands_free", request);
  }

  /// Carries the LED from corner to corner until each is captured.
  static void carryAround() {
    for (std::size_t c = 0; c < kCorners.size(); ++c) {
      cameras_->carryLed(kCorners[c], 0.5);
      ASSERT_TRUE(waitUntil([c] { return status_->get()->corners_captured == c + 1; }))
          << status_->get()->message;
    }
  }

  static void wave() {
    cameras_->waveLed(true);
    const auto started = call<StartWave>("calibration/start_wave");
    ASSERT_TRUE(started.success) << started.message;
    ASSERT_TRUE(waitForStep(CalibrationStatus::WAVING));
    ASSERT_TRUE(waitUntil([] { return status_->get()->missing.empty(); }))
        << status_->get()->missing.front();
    const auto stopped = call<std_srvs::Trigger>("calibration/stop_wave");
    ASSERT_TRUE(stopped.success) << stopped.message;
    EXPECT_SAYS(stopped.message, "enough: solve");
    cameras_->waveLed(false);
  }
};

/// As after a step of a clock, or from another computer.
TEST_F(WavesAndMasks, ACaptureIsPossibleAfterOneThatWasStampedLater) {
  ros::NodeHandle nh;
  const ros::Publisher goals = nh.advertise<wiimote_tracker_msgs::CaptureCornerActionGoal>(
      "calibration/capture_corner/goal", 10);
  ASSERT_TRUE(waitUntil([&] { return goals.getNumSubscribers() > 0; }));
  ASSERT_TRUE(start(2.5).success);
  putLed(kCorners[0]);
  wiimote_tracker_msgs::CaptureCornerActionGoal later;
  later.goal_id.id = "half an hour later";
  later.goal_id.stamp = ros::Time::now() + ros::Duration(1800.0);
  goals.publish(later);
  ASSERT_TRUE(waitUntil([] { return status_->get()->corners_captured == 1; }));
  putLed(kCorners[1]);
  const auto result = capture();
  EXPECT_TRUE(result.success) << result.message;
  EXPECT_EQ(capture_->getState(), actionlib::SimpleClientGoalState::SUCCEEDED);
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
}

TEST_F(WavesAndMasks, AWaveIsRecordedWithItsCoverageAndSolvedWithTheSquare) {
  EXPECT_FALSE(call<StartWave>("calibration/start_wave").success);
  EXPECT_SAYS(call<std_srvs::Trigger>("calibration/stop_wave").message, "no wave");
  captureAll();
  cameras_->waveLed(true);
  ASSERT_TRUE(call<StartWave>("calibration/start_wave").success);
  boost::shared_ptr<const CalibrationStatus> status;
  EXPECT_TRUE(waitUntil([&] {
    status = status_->get();
    return status->step == CalibrationStatus::WAVING && status->wave_seconds > 0.5;
  }));
  cameras_->waveLed(false);  // before it is enough to be solved
  EXPECT_FALSE(status->missing.empty());
  EXPECT_LT(status->progress, 1.0);
  ASSERT_EQ(status->cameras[2].image_cells.size(), 48U);
  EXPECT_GT(status->cameras[2].image_coverage, 0.0);
  EXPECT_GT(status->cameras[2].speed, 10.0);
  EXPECT_GT(status->cameras[2].wave_seconds, 0.0);
  EXPECT_SAYS(call<SolveCalibration>("calibration/solve").message, "a wave is being recorded");
  call<std_srvs::Trigger>("calibration/stop_wave");
  wave();

  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  EXPECT_SAYS(solved.rig.method, "wave");
  ASSERT_EQ(solved.rig.cameras.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d center = vectorOf(solved.rig.cameras[i].world_from_camera.position);
    EXPECT_LT((center - cameras_->truth[i].center()).norm(), 0.03);
    EXPECT_LT(std::abs(solved.rig.cameras[i].time_offset), 0.0005);
  }
}

TEST_F(WavesAndMasks, AWandOnTheFloorTakesOneRequestToStartAndOneToSolve) {
  const Eigen::Vector3d origin(1.0, 1.2, 0.0);
  cameras_->putLed(origin);
  cameras_->holdWand(true);
  wiimote_tracker_msgs::StartCalibration::Request request;
  request.side_x = 2.5;
  request.wand_length = 0.5;
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request).message,
              "replaces the square");
  request.without_square = true;
  request.wand_length = -0.5;
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request).message,
              "wand_length");
  request.wand_length = 0.5;
  request.cameras = {"camera_2", "camera_3"};
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request).message,
              "no camera has an accelerometer");
  request.cameras.clear();
  const auto started = call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request);
  ASSERT_TRUE(started.success) << started.message;
  EXPECT_SAYS(started.message, "leave the wand on the floor");
  boost::shared_ptr<const CalibrationStatus> lying;
  ASSERT_TRUE(waitUntil([&] {
    lying = status_->get();
    return lying->next_title == "Leave it";
  }));
  EXPECT_SAYS(lying->next_sentence, "end nearer to camera_1");
  EXPECT_SAYS(lying->missing.front(), "leave it on the floor");
  EXPECT_TRUE(waitUntil([] {
    const auto camera = status_->get()->cameras[0];
    return camera.blobs == 2 && camera.problem.empty();
  }));
  ASSERT_TRUE(waitUntil([] { return status_->get()->next_title == "Wave"; }))
      << status_->get()->missing.front();
  EXPECT_SAYS(status_->get()->message, "lift it, and wave it");
  cameras_->waveLed(true);
  ASSERT_TRUE(waitUntil([] { return status_->get()->next_request == "solve"; }))
      << status_->get()->missing.front();
  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  EXPECT_EQ(solved.rig.method, "floor+wand");
  Eigen::Vector3d x = origin - cameras_->truth[0].center();
  x = Eigen::Vector3d(x.x(), x.y(), 0.0).normalized();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d center = vectorOf(solved.rig.cameras[i].world_from_camera.position);
    const Eigen::Vector3d from_origin = cameras_->truth[i].center() - origin;
    const Eigen::Vector3d truth(x.dot(from_origin),
                                x.x() * from_origin.y() - x.y() * from_origin.x(), from_origin.z());
    EXPECT_LT((center - truth).norm(), 0.05) << i;
  }
}

TEST_F(WavesAndMasks, LampsAreLearnedMaskedAndStoredInTheRig) {
  const Eigen::Vector3d lamp(0.4, 1.9, 1.4);
  cameras_->setLamps({lamp});
  wiimote_tracker_msgs::LearnMasks::Request request;
  request.duration = 1.0;
  wiimote_tracker_msgs::LearnMasks::Response learned;
  // The LED is switched off only when the status asks for it, as by the simulated hand. On a busy
  // computer that may come too late: then once more.
  const auto learn = [&] {
    cameras_->switchLed(true);
    std::thread person([] {
      waitUntil([] { return status_->get()->step == CalibrationStatus::MASKING; });
      cameras_->switchLed(false);
    });
    learned = call<wiimote_tracker_msgs::LearnMasks>("calibration/learn_masks", request);
    person.join();
    return learned.success && learned.masks == std::vector<std::uint32_t>({1, 1, 1, 1});
  };
  EXPECT_TRUE(waitUntil(learn)) << learned.message;
  EXPECT_SAYS(learned.message, "exactly one light: if that is the LED");
  EXPECT_TRUE(waitUntil([] {
    const auto status = status_->get();
    const auto& camera = status->cameras[3];
    return camera.masks == 1 && camera.blobs == 0;
  }));

  cameras_->switchLed(true);
  captureAll();
  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(solved.rig.cameras[i].masks.size(), 1U);
    const Eigen::Vector2d pixel = cameras_->truth[i].project(lamp).value();
    const auto& mask = solved.rig.cameras[i].masks[0];
    EXPECT_LT((Eigen::Vector2d(mask.x, mask.y) - pixel).norm(), 1.0);
    EXPECT_LT(mask.radius, 12.0);
  }
  const auto cleared = call<std_srvs::Trigger>("calibration/clear_masks");
  EXPECT_TRUE(cleared.success);
  EXPECT_SAYS(cleared.message, "the rig in use has no masks now: save it");
  EXPECT_TRUE(waitUntil([] {
    const auto status = status_->get();
    const auto& camera = status->cameras[3];
    return camera.masks == 0 && camera.blobs == 2;
  }));

  // The rig that is in use says so too.
  Latest<RigCalibration> rig("calibration/rig");
  const auto rigHasMasks = [&](std::size_t count) {
    return waitUntil([&] {
      const auto message = rig.get();
      return message && message->cameras[3].masks.size() == count;
    });
  };
  EXPECT_TRUE(rigHasMasks(0));
  cameras_->switchLed(false);
  EXPECT_TRUE(waitUntil([&] {
    learned = call<wiimote_tracker_msgs::LearnMasks>("calibration/learn_masks", request);
    return learned.success && learned.masks == std::vector<std::uint32_t>({1, 1, 1, 1});
  })) << learned.message;
  EXPECT_SAYS(learned.message, "save it to keep that");
  EXPECT_TRUE(rigHasMasks(1));
  EXPECT_EQ(rig.get()->cameras[3].world_from_camera.position.x,
            solved.rig.cameras[3].world_from_camera.position.x);
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/clear_masks").success);
  EXPECT_TRUE(rigHasMasks(0));
  cameras_->switchLed(true);
}

TEST_F(WavesAndMasks, TheButtonOfASpareRemoteCaptures) {
  wiimote_tracker_msgs::StartCalibration::Request request;
  request.side_x = 2.5;
  request.cameras = {"camera_1", "camera_2", "spare"};
  EXPECT_SAYS(call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request).message,
              "moves when its button is pressed");
  ASSERT_TRUE(start(2.5).success);
  putLed(kCorners[0]);
  ros::NodeHandle nh;
  ros::Publisher joy = nh.advertise<sensor_msgs::Joy>("spare/joy", 10, true);
  ASSERT_TRUE(waitUntil([&] { return joy.getNumSubscribers() > 0; }));
  sensor_msgs::Joy message;
  message.buttons.assign(11, 0);
  joy.publish(message);
  const auto capturedLater = [] {
    const ros::Time later = ros::Time::now() + ros::Duration(1.0);
    EXPECT_TRUE(waitUntil([&] { return status_->get()->header.stamp > later; }));
    return status_->get()->corners_captured;
  };
  message.buttons[3] = 1;  // B
  joy.publish(message);
  EXPECT_EQ(capturedLater(), 0U);
  message.buttons[2] = 1;  // and A
  joy.publish(message);
  joy.publish(message);  // still held
  ASSERT_TRUE(waitUntil([] { return status_->get()->corners_captured == 1; }))
      << status_->get()->message;
  EXPECT_SAYS(status_->get()->message, "corner 1 captured by 4 of 4");
  putLed(kCorners[1]);
  joy.publish(message);
  EXPECT_EQ(capturedLater(), 1U);
}

TEST_F(WavesAndMasks, ADriverThatDoesNotAnswerDoesNotDelaySaving) {
  captureAll();
  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  EXPECT_TRUE(waitUntil([] {
    cameras_->hang("camera_3");
    const auto saved = call<SaveRig>("calibration/save");
    EXPECT_TRUE(saved.success);
    EXPECT_SAYS(saved.message, "camera_3 does not answer set_camera_info in time");
    cameras_->hang("");
    EXPECT_TRUE(waitUntil([] { return cameras_->cameraInfos().count("camera_3") == 1; }));
    // On a busy computer another one, which answers at once, may be late too.
    return saved.message.find("camera_2") == std::string::npos;
  }));

  // A rig does not replace the file of a camera's lens.
  SaveRig::Request request;
  request.path = folder_ + "/camera_1.yaml";
  const auto refused = call<SaveRig>("calibration/save", request);
  EXPECT_FALSE(refused.success);
  EXPECT_SAYS(refused.message, "save the rig by another name");
  EXPECT_THROW(geometry::readRigFile(request.path), Error);
}

TEST_F(WavesAndMasks, ACaptureThatEndsWithItsServerSaysWhy) {
  ros::NodeHandle nh;
  const ros::Publisher cancel =
      nh.advertise<actionlib_msgs::GoalID>("calibration/capture_corner/cancel", 10);
  ASSERT_TRUE(waitUntil([&] { return cancel.getNumSubscribers() > 0; }));
  ASSERT_TRUE(start(2.5).success);
  cameras_->blind({"camera_1", "camera_2", "camera_3", "camera_4"});
  capture_->sendGoal(wiimote_tracker_msgs::CaptureCornerGoal());
  ASSERT_TRUE(waitForStep(CalibrationStatus::CAPTURING));
  actionlib_msgs::GoalID of_another;
  of_another.id = "unknown";
  of_another.stamp = ros::TIME_MAX;
  cancel.publish(of_another);
  ASSERT_TRUE(capture_->waitForResult(ros::Duration(kPatience)));
  EXPECT_SAYS(capture_->getResult()->message, "from a computer whose clock is wrong");
  EXPECT_TRUE(call<std_srvs::Trigger>("calibration/cancel").success);
  EXPECT_TRUE(waitForStep(CalibrationStatus::IDLE));
}

class BagWriter : public Recorder {
 public:
  explicit BagWriter(const std::string& path) : bag_(path, rosbag::bagmode::Write) {}
  void write(const std::string& topic, const wiimote_tracker_msgs::IrBlobArray& message) override {
    bag_.write(topic, message.header.stamp, message);
  }
  void write(const std::string& topic, const sensor_msgs::Imu& message) override {
    bag_.write(topic, message.header.stamp, message);
  }

 private:
  rosbag::Bag bag_;
};

TEST_F(WavesAndMasks, ABagGivesTheSameRigAsLiveImages) {
  // Live: hands-free, and recorded.
  const std::string path = folder_ + "/session.bag";
  cameras_->switchLed(false);
  cameras_->putLed(kCorners[0] - Eigen::Vector3d(1.0, 0.0, 0.0));
  ASSERT_TRUE(start(2.5).success);
  ASSERT_TRUE(handsFree("", true).success);
  {
    BagWriter bag(path);
    cameras_->record(&bag);
    // All cameras are in the bag before there is anything to see.
    ASSERT_TRUE(waitForStatus());
    ASSERT_TRUE(waitUntil([] {
      const auto status = status_->get();
      for (const auto& camera : status->cameras) {
        if (camera.blobs != 0)
          return false;
      }
      return true;
    }));
    cameras_->switchLed(true);
    carryAround();
    cameras_->record(nullptr);
  }
  EXPECT_TRUE(status_->get()->hands_free);
  ASSERT_TRUE(handsFree("", false).success);
  const auto live = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(live.success) << live.message;

  // From the bag, at half the speed: faster images would be too many for the queues of a node that
  // does not run for some tenths of a second. Only the new node lives in simulated time.
  ros::param::set("/use_sim_time", true);
  {
    const Process process("/replayed",
                          {"_rig_file:=" + folder_ + "/replayed.yaml", "_minimum_samples:=20",
                           "_hands_free:=true", "_hands_free_hold:=0.5"});
    ASSERT_TRUE(
        ros::service::waitForService("/replayed/calibration/start", ros::Duration(kPatience)));
    wiimote_tracker_msgs::StartCalibration::Request request;
    request.side_x = 2.5;
    request.cameras = {"camera_1", "camera_2", "camera_3", "camera_4"};
    const std::string play =
        "rosbag play --clock -r 0.5 --queue=100000 --pause --wait-for-subscribers "
        "--prefix=/replayed '" +
        path + "' __name:=player > /dev/null 2>&1";
    Latest<CalibrationStatus> status("/replayed/calibration/status");
    std::thread player([&] { EXPECT_EQ(std::system(play.c_str()), 0); });
    // The bag's cameras are advertised before the first message is sent.
    EXPECT_TRUE(waitUntil([&] {
      return call<wiimote_tracker_msgs::StartCalibration>("/replayed/calibration/start", request)
          .success;
    }));
    EXPECT_TRUE(call<std_srvs::SetBool>("/player/pause_playback").success) << "it plays";
    player.join();
    EXPECT_TRUE(waitUntil([&] { return status.get() && status.get()->corners_captured == 4; }))
        << status.get()->message;
    const auto replayed = call<SolveCalibration>("/replayed/calibration/solve");
    EXPECT_TRUE(replayed.success) << replayed.message;
    EXPECT_EQ(replayed.rig.id, live.rig.id);
    EXPECT_EQ(replayed.rig.covariance, live.rig.covariance);
  }
  ros::param::set("/use_sim_time", false);
}

}  // namespace
}  // namespace wiimote_tracker
