#pragma once

#include "call_service.h"
#include "expect_says.h"
#include "fake_cameras.h"

#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>
#include <wiimote_tracker_triangulation/ros/message_fields.h>

#include <actionlib/client/simple_action_client.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>
#include <wiimote_tracker_msgs/CalibrationVerdict.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/SaveRig.h>
#include <wiimote_tracker_msgs/SolveCalibration.h>
#include <wiimote_tracker_msgs/StartCalibration.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::CalibrationStatus;
using wiimote_tracker_msgs::CheckConnection;
using wiimote_tracker_msgs::LoadRig;
using wiimote_tracker_msgs::RigCalibration;
using wiimote_tracker_msgs::SaveRig;
using wiimote_tracker_msgs::SolveCalibration;
using Client = actionlib::SimpleActionClient<wiimote_tracker_msgs::CaptureCornerAction>;

constexpr double kPatience = 30.0;  // [s] far beyond what anything here takes

inline bool waitUntil(const std::function<bool()>& condition) {
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kPatience);
  while (ros::ok() && ros::SteadyTime::now() < end) {
    if (condition())
      return true;
    ros::WallDuration(0.01).sleep();
  }
  return condition();
}

inline bool exists(const std::string& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0;
}

inline std::string contents(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Latest message of a latched topic.
template <typename Message>
class Latest {
 public:
  explicit Latest(const std::string& topic)
      : subscriber_(nh_.subscribe<Message>(topic,
                                           100,
                                           [this](const boost::shared_ptr<const Message>& message) {
                                             const std::lock_guard<std::mutex> lock(mutex_);
                                             message_ = message;
                                           })) {}

  boost::shared_ptr<const Message> get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return message_;
  }

 private:
  ros::NodeHandle nh_;
  mutable std::mutex mutex_;
  boost::shared_ptr<const Message> message_;
  ros::Subscriber subscriber_;
};

/// Waits for diagnostics whose first message has this part.
inline bool waitForDiagnosis(const std::string& part) {
  const Latest<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  return waitUntil([&] {
    const auto array = diagnostics.get();
    return array && array->status.at(0).message.find(part) != std::string::npos;
  });
}

/// The node in /calibration, its cameras, and what a person does with both.
class Node : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    cameras_ = std::make_unique<FakeCameras>();
    status_ = std::make_unique<Latest<CalibrationStatus>>("calibration/status");
    capture_ = std::make_unique<Client>("calibration/capture_corner", true);
    std::string rig_file;
    ASSERT_TRUE(ros::param::get("/calibration/rig_file", rig_file));
    folder_ = rig_file.substr(0, rig_file.rfind('/'));
    ASSERT_TRUE(capture_->waitForServer(ros::Duration(kPatience)));
    ASSERT_TRUE(waitUntil([] {
      const auto status = status_->get();
      int connected = 0;
      if (status) {
        for (const auto& camera : status->cameras)
          connected += camera.connected;
      }
      return connected == 4;
    }));
  }
  static void TearDownTestSuite() {
    capture_.reset();
    status_.reset();
    cameras_.reset();
    if (folder_.compare(0, 5, "/tmp/") == 0) {
      EXPECT_EQ(std::system(("rm -r '" + folder_ + "'").c_str()), 0);
    }
  }
  void SetUp() override {
    cameras_->blind({});
    cameras_->switchLed(true);
    cameras_->setLamps({});
    cameras_->waveLed(false);
    cameras_->waveSecondLed(false);
    cameras_->holdWand(false);
  }

  template <typename Service>
  static typename Service::Response call(const std::string& name,
                                         const typename Service::Request& request = {}) {
    return callService<Service>(name, request);
  }

  static wiimote_tracker_msgs::StartCalibration::Response start(double side_x,
                                                                double side_y = 0.0) {
    wiimote_tracker_msgs::StartCalibration::Request request;
    request.side_x = side_x;
    request.side_y = side_y;
    return call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request);
  }

  /// Puts the LED down, and waits until the node sees it there.
  static void putLed(const Eigen::Vector3d& place) {
    cameras_->putLed(place);
    ASSERT_TRUE(waitUntil([&] {
      CheckConnection::Request request;
      request.duration = 0.05;
      const auto response = call<CheckConnection>("calibration/check_connection", request);
      for (std::size_t i = 0; i < response.cameras.size(); ++i) {
        const auto& camera = response.cameras[i];
        const Eigen::Vector2d pixel = cameras_->truth[i].project(place).value();
        if (camera.blobs == 1 && !((Eigen::Vector2d(camera.x, camera.y) - pixel).norm() < 1.0))
          return false;
      }
      return response.cameras.size() == 4;
    }));
  }

  static wiimote_tracker_msgs::CaptureCornerResult capture(int retake = -1) {
    wiimote_tracker_msgs::CaptureCornerGoal goal;
    goal.retake = retake >= 0;
    goal.corner = static_cast<std::uint32_t>(std::max(retake, 0));
    capture_->sendGoal(goal);
    EXPECT_TRUE(capture_->waitForResult(ros::Duration(kPatience)));
    return *capture_->getResult();
  }

  /// Captures the next corner with all cameras. One whose images come late, as to a node that did
  /// not run for some tenths of a second, is left out: then the corner is captured again.
  static wiimote_tracker_msgs::CaptureCornerResult captureByAll() {
    wiimote_tracker_msgs::CaptureCornerResult result = capture();
    EXPECT_TRUE(waitUntil([&] {
      const auto is_left_out = [&](const wiimote_tracker_msgs::CalibrationCameraStatus& camera) {
        return camera.samples.at(result.corner) == 0;
      };
      if (!result.success ||
          std::none_of(result.cameras.begin(), result.cameras.end(), is_left_out))
        return true;
      result = capture(static_cast<int>(result.corner));
      return false;
    }));
    return result;
  }

  static void captureAll() {
    const auto started = start(2.5);
    ASSERT_TRUE(started.success) << started.message;
    for (const Eigen::Vector3d& corner : kCorners) {
      putLed(corner);
      const auto result = captureByAll();
      ASSERT_TRUE(result.success) << result.message;
    }
  }

  static bool waitForStep(std::uint8_t step) {
    return waitUntil([step] { return status_->get()->step == step; });
  }

  /// Waits for a status that was published after this call, so that it shows what was replied
  /// before.
  static bool waitForStatus() {
    const ros::Time now = ros::Time::now();
    return waitUntil([now] { return status_->get()->header.stamp > now; });
  }

  static const std::vector<Eigen::Vector3d> kCorners;
  static std::unique_ptr<FakeCameras> cameras_;
  static std::unique_ptr<Latest<CalibrationStatus>> status_;
  static std::unique_ptr<Client> capture_;
  static std::string folder_;
};

const std::vector<Eigen::Vector3d> Node::kCorners = {{0.0, 0.0, 0.0},
                                                     {2.5, 0.0, 0.0},
                                                     {2.5, 2.5, 0.0},
                                                     {0.0, 2.5, 0.0}};
std::unique_ptr<FakeCameras> Node::cameras_;
std::unique_ptr<Latest<CalibrationStatus>> Node::status_;
std::unique_ptr<Client> Node::capture_;
std::string Node::folder_;

/// A calibration node started by this test, in a namespace of its own.
class Process {
 public:
  Process(const std::string& name_space, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"rosrun", "wiimote_tracker_calibration",
                                         "calibration_node", "__ns:=" + name_space});
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (std::string& argument : arguments)
      pointers.push_back(&argument[0]);
    pointers.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      execvp("rosrun", pointers.data());
      _exit(127);
    }
  }
  ~Process() {
    kill(pid_, SIGINT);
    int status = 0;
    waitpid(pid_, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }

 private:
  pid_t pid_;
};

}  // namespace
}  // namespace wiimote_tracker
