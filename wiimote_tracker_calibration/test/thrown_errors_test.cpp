// Whatever a job of the calibration node throws becomes a refusal, and the next request works.

#include "capture/camera_monitor.h"

#include "node_fixture.h"

#include "../src/ros/calibration_node.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/FitRemap.h>
#include <wiimote_tracker_msgs/JoinRig.h>
#include <wiimote_tracker_msgs/LearnMasks.h>
#include <wiimote_tracker_msgs/LoadSamples.h>
#include <wiimote_tracker_msgs/RecalibrateCamera.h>
#include <wiimote_tracker_msgs/SaveSamples.h>
#include <wiimote_tracker_msgs/SolveBoard.h>
#include <wiimote_tracker_msgs/StartBoard.h>
#include <wiimote_tracker_msgs/StartWave.h>
#include <opencv2/core.hpp>

#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

using namespace wiimote_tracker_msgs;
using workflow::Reply;

std::unique_ptr<CalibrationNode> node;

void setFault(const std::function<void()>& fault) {
  const Lock lock(node->context().mutex());
  node->context().fault = fault;
}

template <typename Service>
Reply replyTo(const std::string& name, typename Service::Request request = {}) {
  const auto response = callService<Service>(name, request);
  return {response.success != 0, response.message};
}

/// Repeats a request that is refused because too few images came in its time, as on a busy
/// computer.
template <typename Service>
Reply withImages(const std::string& name, typename Service::Request request = {}) {
  Reply reply;
  EXPECT_TRUE(waitUntil([&] {
    reply = replyTo<Service>(name, request);
    return reply.message.find(capture::kSendsNoImages) == std::string::npos &&
           reply.message.find("look for a longer time") == std::string::npos;
  }));
  return reply;
}

/// A request that takes time, and whether it succeeds when nothing is thrown.
struct Case {
  std::string name;
  bool succeeds;
  std::function<Reply()> request;
};

class ThrownErrors : public Node {
 protected:
  static void SetUpTestSuite() {
    Parameters parameters;
    parameters.calibration.capture.minimum_samples = 20;
    parameters.calibration.capture.timeout = 3.0;
    parameters.set_camera_info_timeout = 0.5;
    // Else one camera of a square alone, without clocks, is refused before anything is thrown.
    parameters.solve.wave.maximum_offset_stddev = 1.0;
    ros::param::get("/calibration/rig_file", parameters.rig_file);
    node = std::make_unique<CalibrationNode>(ros::NodeHandle(), parameters);
    Node::SetUpTestSuite();
  }
  static void TearDownTestSuite() {
    Node::TearDownTestSuite();
    node.reset();
  }

  static std::vector<Case> cases() {
    geometry_msgs::Point corner;
    corner.y = 2.5;
    CheckPlace::Request place;
    place.known = corner;
    AddKnownPlace::Request known;
    known.known = corner;
    LearnMasks::Request masks;
    masks.duration = 0.5;
    RecalibrateCamera::Request camera;
    camera.camera = "camera_1";
    camera.duration = 0.2;
    return {
        {"solve", true, [] { return replyTo<SolveCalibration>("calibration/solve"); }},
        {"capture_corner", true,
         [] {
           const auto result = capture(3);
           return Reply{result.success != 0, result.message};
         }},
        {"check", true, [=] { return replyTo<CheckPlace>("calibration/check", place); }},
        {"known_places/add", true,
         [=] {
           const Reply reply = replyTo<AddKnownPlace>("calibration/known_places/add", known);
           call<std_srvs::Trigger>("calibration/known_places/clear");
           return reply;
         }},
        {"known_places/fit", false,
         [] { return replyTo<FitRemap>("calibration/known_places/fit"); }},
        {"recalibrate_camera", false,
         [=] { return replyTo<RecalibrateCamera>("calibration/recalibrate_camera", camera); }},
        {"save", true, [] { return replyTo<SaveRig>("calibration/save"); }},
        {"load", true, [] { return replyTo<LoadRig>("calibration/load"); }},
        {"join", false, [] { return replyTo<JoinRig>("calibration/join"); }},
        {"check_connection", true,
         [] { return withImages<CheckConnection>("calibration/check_connection"); }},
        {"start_wave", true,
         [] {
           const Reply reply = replyTo<StartWave>("calibration/start_wave");
           if (reply.success)
             call<std_srvs::Trigger>("calibration/cancel");
           return reply;
         }},
        {"board/solve", false, [] { return replyTo<SolveBoard>("calibration/board/solve"); }},
        {"save_samples", true, [] { return replyTo<SaveSamples>("calibration/save_samples"); }},
        {"load_samples", true, [] { return replyTo<LoadSamples>("calibration/load_samples"); }},
        {"learn_masks", true,
         [=] {
           const Reply reply = withImages<LearnMasks>("calibration/learn_masks", masks);
           call<std_srvs::Trigger>("calibration/clear_masks");
           return reply;
         }},
    };
  }
};

TEST_F(ThrownErrors, BecomeRefusalsAndTheNextRequestWorks) {
  captureAll();
  ASSERT_TRUE(call<SolveCalibration>("calibration/solve").success);
  StartBoard::Request board;
  board.camera = "camera_1";
  ASSERT_TRUE(call<StartBoard>("calibration/board/start", board).success);

  const std::vector<std::pair<std::string, std::function<void()>>> faults = {
      {"memory", [] { throw std::bad_alloc(); }},
      {"bad matrix",
       [] { throw cv::Exception(cv::Error::StsBadArg, "bad matrix", "solve", "file", 1); }},
      {"an unexpected error", [] { throw 7; }},
      {"no solution", [] { throw Error("no solution"); }},
  };
  for (const Case& each : cases()) {
    for (const auto& [part, fault] : faults) {
      SCOPED_TRACE(each.name + ": " + part);
      setFault(fault);
      const Reply refused = each.request();
      EXPECT_FALSE(refused.success);
      EXPECT_SAYS(refused.message, part);
      setFault([] {});
      const Reply next = each.request();
      EXPECT_EQ(next.success, each.succeeds) << next.message;
      EXPECT_EQ(next.message.find(part), std::string::npos) << next.message;
      EXPECT_EQ(next.message.find("wait until"), std::string::npos) << next.message;
    }
  }
}

TEST_F(ThrownErrors, ATimeThatIsTooShortForAnImageIsNotTheCamerasFault) {
  LearnMasks::Request masks;
  masks.duration = 0.001;
  EXPECT_SAYS(replyTo<LearnMasks>("calibration/learn_masks", masks).message, "0.05 and 60 s");
}

TEST_F(ThrownErrors, ARefusalIsHeardOnce) {
  const auto refusals = [] {
    const Lock lock(node->context().mutex());
    return node->context().calibration(lock).refusals();
  };
  ASSERT_TRUE(replyTo<std_srvs::Trigger>("calibration/known_places/clear").success);
  const std::size_t before = refusals();
  EXPECT_FALSE(start(-1.0).success);
  EXPECT_EQ(refusals(), before + 1);
  EXPECT_FALSE(replyTo<std_srvs::Trigger>("calibration/known_places/undo").success);
  EXPECT_EQ(refusals(), before + 2);
  EXPECT_FALSE(replyTo<std_srvs::Trigger>("calibration/stop_wave").success);
  EXPECT_EQ(refusals(), before + 3);
  LearnMasks::Request masks;
  masks.duration = 0.001;
  EXPECT_FALSE(replyTo<LearnMasks>("calibration/learn_masks", masks).success);
  EXPECT_EQ(refusals(), before + 4);
  LoadRig::Request elsewhere;
  elsewhere.path = "/etc/hostname";
  EXPECT_FALSE(replyTo<LoadRig>("calibration/load", elsewhere).success);
  EXPECT_EQ(refusals(), before + 5);
  RecalibrateCamera::Request camera;
  camera.camera = "camera_9";
  EXPECT_FALSE(replyTo<RecalibrateCamera>("calibration/recalibrate_camera", camera).success);
  EXPECT_EQ(refusals(), before + 6);
  // One that comes after a step has begun.
  cameras_->switchLed(false);
  CheckPlace::Request place;
  place.duration = 0.05;
  EXPECT_FALSE(replyTo<CheckPlace>("calibration/check", place).success);
  EXPECT_EQ(refusals(), before + 7);
}

TEST_F(ThrownErrors, AStartWithALensOfAnotherImageSizeDropsNothing) {
  captureAll();
  const auto setWidth = [](int width) {
    const Lock lock(node->context().mutex());
    node->context().parameters(lock).own_intrinsics["camera_2"].width = width;
  };
  setWidth(640);
  StartCalibration::Request request;
  request.without_square = true;
  request.wand_length = 0.5;
  EXPECT_SAYS(replyTo<StartCalibration>("calibration/start", request).message,
              "its starting intrinsics are for 640 x 768");
  const auto with_square = start(1.0);
  EXPECT_SAYS(with_square.message, "its starting intrinsics are for 640 x 768");
  EXPECT_SAYS(with_square.message, "for this camera, and start the node again");
  setWidth(1024);
  EXPECT_TRUE(waitForStep(CalibrationStatus::COMPLETE));
  EXPECT_EQ(status_->get()->corners_captured, 4U);
}

TEST_F(ThrownErrors, ACaptureEndsWhenAnotherCalibrationIsStarted) {
  ASSERT_TRUE(start(2.5).success);
  setFault([] {  // called with the mutex locked, before the capture looks whether it has ended
    const Lock locked_already(node->context().mutex(), std::defer_lock);
    workflow::Calibration& calibration = node->context().calibration(locked_already);
    const std::vector<std::string> cameras = calibration.cameras();
    calibration.cancel();
    EXPECT_TRUE(calibration.start(1.0, 1.0, cameras).success);
  });
  const auto result = capture();
  setFault([] {});
  EXPECT_FALSE(result.success);
  EXPECT_SAYS(result.message, "another calibration was started meanwhile");
  // The status of the calibration before may be the latest for a moment.
  EXPECT_TRUE(waitUntil([] {
    return status_->get()->square_sides == std::vector<double>({1.0, 1.0});
  }));
  EXPECT_TRUE(waitForStep(CalibrationStatus::READY));
  EXPECT_TRUE(replyTo<std_srvs::Trigger>("calibration/cancel").success);
}

TEST_F(ThrownErrors, AWaveIsRefusedWhenAnotherCalibrationIsStarted) {
  captureAll();
  setFault([] {
    const Lock lock(node->context().mutex());
    EXPECT_TRUE(
        node->context().calibration(lock).start(1.0, 1.0, {"camera_1", "camera_2"}).success);
  });
  const Reply reply = replyTo<StartWave>("calibration/start_wave");
  setFault([] {});
  EXPECT_FALSE(reply.success);
  EXPECT_SAYS(reply.message, "what was captured has changed meanwhile");
  EXPECT_TRUE(waitForStep(CalibrationStatus::READY));
  EXPECT_TRUE(replyTo<std_srvs::Trigger>("calibration/cancel").success);
}

TEST_F(ThrownErrors, NothingElseChangesTheRigWhileTheSolverRuns) {
  captureAll();
  ASSERT_TRUE(call<SolveCalibration>("calibration/solve").success);
  captureAll();
  std::promise<std::vector<Reply>> promise;
  setFault([&] {
    setFault([] {});
    promise.set_value({replyTo<std_srvs::Trigger>("calibration/clear_masks"),
                       replyTo<JoinRig>("calibration/join"),
                       replyTo<FitRemap>("calibration/known_places/fit")});
  });
  const auto solved = call<SolveCalibration>("calibration/solve");
  ASSERT_TRUE(solved.success) << solved.message;
  for (const Reply& reply : promise.get_future().get()) {
    EXPECT_FALSE(reply.success);
    EXPECT_SAYS(reply.message, "the solver runs");
  }
}

TEST_F(ThrownErrors, AChangedRigLeavesTheMasksOfLoadedSamples) {
  captureAll();
  ASSERT_TRUE(call<SolveCalibration>("calibration/solve").success);
  NodeContext& context = node->context();
  const Lock lock(context.mutex());
  samples::Samples samples = context.samples(lock);
  samples.recording.cameras[0].masks = {{{1000.0, 20.0}, 5.0}};
  ASSERT_TRUE(context.setSamples(samples, lock).success);
  const geometry::Rig rig = context.existingRig("to change", lock);
  context.setRig(rig, "changed", lock);
  EXPECT_EQ(context.samples(lock).recording.cameras[0].masks.size(), 1U);
  context.setMasks({}, lock);
}

TEST_F(ThrownErrors, EndNoThreadThatImagesComeFrom) {
  // Images come until the node ends, after this test.
  const auto thrown = std::make_shared<bool>(false);
  {
    const Lock lock(node->context().mutex());
    node->context().inputs().subscribeImages([thrown](const capture::Image&, const Lock&) {
      if (!std::exchange(*thrown, true))
        throw 7;
    });
  }
  EXPECT_TRUE(waitUntil([&] {
    const Lock lock(node->context().mutex());
    return *thrown;
  }));
  const Reply reply = withImages<CheckConnection>("calibration/check_connection");
  EXPECT_TRUE(reply.success) << reply.message;
}

// The last test: the node keeps the camera.
TEST_F(ThrownErrors, ImagesWithoutSizeFitNoLens) {
  ros::NodeHandle nh;
  ros::Publisher images = nh.advertise<IrBlobArray>("camera_5/ir_blobs", 1, true);
  images.publish(IrBlobArray());
  NodeContext& context = node->context();
  EXPECT_TRUE(waitUntil([&] {
    const Lock lock(context.mutex());
    try {
      context.facts({"camera_5"}, lock);
    } catch (const Refusal& refusal) {
      return std::string(refusal.what()).find("camera_5 have no size") != std::string::npos;
    }
    return false;
  }));
}

}  // namespace
}  // namespace wiimote_tracker
