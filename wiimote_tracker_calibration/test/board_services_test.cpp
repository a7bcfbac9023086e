// A person with a board before a camera that this test plays: from the first view to the lens that
// its driver gets. Images come faster than real ones; all times are theirs.
#include "board_lenses.h"
#include "board_table.h"
#include "call_service.h"
#include "expect_says.h"

#include "samples/samples_file.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/BoardStatus.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/SaveSamples.h>
#include <wiimote_tracker_msgs/SolveBoard.h>
#include <wiimote_tracker_msgs/StartBoard.h>
#include <wiimote_tracker_msgs/StartCalibration.h>
#include <wiimote_tracker_msgs/StartWave.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::BoardStatus;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::SolveBoard;

constexpr double kPatience = 60.0;  // [s] far beyond what anything here takes
constexpr double kPeriod = 0.01;    // of the images, by their stamps [s]

/// The camera, its driver, and what the node says.
class Bench {
 public:
  Bench() : random_(5) {
    images_ = nh_.advertise<IrBlobArray>("wiimote_1/ir_blobs", 10000);
    info_ = nh_.advertiseService<sensor_msgs::SetCameraInfo::Request,
                                 sensor_msgs::SetCameraInfo::Response>(
        "wiimote_1/set_camera_info", [this](auto& request, auto& response) {
          camera_info_ = request.camera_info;
          response.success = true;
          return true;
        });
    status_subscriber_ = nh_.subscribe<BoardStatus>(
        "calibration/board", 100, [this](const boost::shared_ptr<const BoardStatus>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          status_ = *message;
        });
  }

  /// The latest one.
  BoardStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }

  /// A board at this pose, as the remote reports it: at most four spots, quantised, with noise; of
  /// the images 5 % are lost on the way.
  void show(const Eigen::Isometry3d& camera_from_board) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    IrBlobArray image;
    image.header.stamp.fromSec(stamp_);
    image.header.frame_id = "wiimote_1_optical_frame";
    image.camera = "wiimote_1";
    image.width = 1024;
    image.height = 768;
    image.max_blobs = 4;
    for (const int led : intrinsics::litAt(stamp_)) {
      const Eigen::Vector2d pixel = intrinsics::projected(truth, camera_from_board, led);
      wiimote_tracker_msgs::IrBlob blob;
      blob.x = std::round(pixel.x() + 0.3 * normal(random_));
      blob.y = std::round(pixel.y() + 0.3 * normal(random_));
      if (truth.isInImage(pixel) && image.blobs.size() < 4)
        image.blobs.push_back(blob);
    }
    stamp_ += kPeriod;
    if (uniform(random_) >= 0.05)
      images_.publish(image);
  }

  /// Holds the board here for a good cycle of image time.
  void hold(const Eigen::Isometry3d& camera_from_board) {
    constexpr int kImages = 260;
    for (int i = 0; i < kImages; ++i) {
      show(camera_from_board);
      if (i % 10 == 0)
        ros::WallDuration(0.005).sleep();  // the node takes what comes within some ms
    }
  }

  /// Repeats an action until the condition holds; false after a minute.
  static bool repeatUntil(const std::function<bool()>& condition,
                          const std::function<void()>& action) {
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kPatience);
    while (ros::ok() && !condition()) {
      if (ros::SteadyTime::now() > end)
        return false;
      action();
    }
    return condition();
  }

  /// Takes the board out of the image, until the node has seen that for a cycle: by then it has
  /// taken all images of the board.
  bool takeAway() {
    Eigen::Isometry3d beside = Eigen::Isometry3d::Identity();
    beside.translation() = Eigen::Vector3d(10.0, 0.0, 1.0);
    return repeatUntil([this] { return status().message.find("no light") == 0; },
                       [&] { hold(beside); });
  }

  /// Shows the board wherever it may be, until so many views are kept and none is missing.
  bool showUntilEnough() {
    return repeatUntil([this] { return status().views >= 12 && status().missing.empty(); },
                       [this] { hold(intrinsics::randomPose(random_)); });
  }

  template <typename Service>
  static typename Service::Response call(const std::string& name,
                                         typename Service::Request request = {}) {
    return callService<Service>(name, request);
  }

  static std_srvs::Trigger::Response trigger(const std::string& name) {
    return call<std_srvs::Trigger>("calibration/board/" + name);
  }

  static wiimote_tracker_msgs::StartBoard::Response start(const std::string& camera,
                                                          double spacing = 0.0) {
    wiimote_tracker_msgs::StartBoard::Request request;
    request.camera = camera;
    request.column_spacing = spacing;
    return call<wiimote_tracker_msgs::StartBoard>("calibration/board/start", request);
  }

  static SolveBoard::Response solve(std::uint8_t model) {
    SolveBoard::Request request;
    request.model = model;
    return call<SolveBoard>("calibration/board/solve", request);
  }

  geometry::Intrinsics truth = intrinsics::paperCamera();
  ros::NodeHandle nh_;
  std::mt19937 random_;
  double stamp_ = 1000.0;
  ros::Publisher images_;
  ros::ServiceServer info_;
  mutable std::mutex mutex_;  // guards status_, which comes in another thread
  BoardStatus status_;
  ros::Subscriber status_subscriber_;
  sensor_msgs::CameraInfo camera_info_;
};

std::unique_ptr<Bench> g_bench;

// In the order in which they stand: each continues where the one before ended.

TEST(Board, RequestsBeforeStartAreRefusedWithAdvice) {
  for (const std::string service : {"undo", "cancel", "commit"}) {
    const auto response = g_bench->trigger(service);
    EXPECT_FALSE(response.success);
    EXPECT_SAYS(response.message, "start one (service calibration/board/start)");
  }
  EXPECT_FALSE(g_bench->solve(SolveBoard::Request::AUTOMATIC).success);
  EXPECT_SAYS(g_bench->start("wiimote_9").message, "no image of a camera 'wiimote_9' has come");
}

TEST(Board, ViewsAreCapturedAutomatically) {
  ASSERT_TRUE(Bench::repeatUntil([] { return g_bench->start("wiimote_1").success; },
                                 [] { g_bench->hold(Eigen::Isometry3d::Identity()); }));
  EXPECT_FALSE(g_bench->start("wiimote_1", -0.1).success);
  Eigen::Isometry3d near = Eigen::Isometry3d::Identity();
  near.translation() = Eigen::Vector3d(-0.15, -0.15, 0.8);
  ASSERT_TRUE(Bench::repeatUntil([] { return g_bench->status().views == 1; },
                                 [&] { g_bench->hold(near); }));
  EXPECT_EQ(g_bench->status().camera, "wiimote_1");
  EXPECT_EQ(g_bench->status().header.frame_id, "wiimote_1_optical_frame");
  EXPECT_EQ(g_bench->status().views_needed, 12U);
  EXPECT_FALSE(g_bench->status().missing.empty());
  // Held on, it adds nothing.
  ASSERT_TRUE(Bench::repeatUntil(
      [] { return g_bench->status().message.find("too much like") != std::string::npos; },
      [&] { g_bench->hold(near); }));
  EXPECT_EQ(g_bench->status().views, 1U);
  ASSERT_TRUE(g_bench->takeAway()) << g_bench->status().message;

  const auto early = g_bench->solve(SolveBoard::Request::AUTOMATIC);
  EXPECT_FALSE(early.success);
  EXPECT_SAYS(early.message, "1 view of the board, at least 12");
  EXPECT_SAYS(g_bench->trigger("commit").message, "solve it first");
  EXPECT_TRUE(g_bench->trigger("undo").success);
  EXPECT_FALSE(g_bench->trigger("undo").success);
}

TEST(Board, ALensComesFromTheViewsWithItsUncertainty) {
  ASSERT_TRUE(g_bench->showUntilEnough())
      << g_bench->status().views << " views; " << g_bench->status().message;
  for (const double bar :
       {g_bench->status().x, g_bench->status().y, g_bench->status().size, g_bench->status().skew})
    EXPECT_EQ(bar, 1.0);
  const auto solved = g_bench->solve(SolveBoard::Request::K1);
  ASSERT_TRUE(solved.success) << solved.message;
  EXPECT_SAYS(solved.message, "reprojection error");
  const sensor_msgs::CameraInfo& info = solved.camera_info;
  EXPECT_EQ(info.width, 1024U);
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  ASSERT_EQ(info.D.size(), 5U);
  ASSERT_EQ(solved.stddev.size(), 9U);
  EXPECT_EQ(solved.stddev[5], 0.0) << "k2 was held";
  const double truth[] = {1306.3, 1302.3, 535.0, 401.7, -0.08};
  const double found[] = {info.K[0], info.K[4], info.K[2], info.K[5], info.D[0]};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_GT(solved.stddev[i], 0.0);
    EXPECT_LT(std::abs(found[i] - truth[i]), 5.0 * solved.stddev[i]) << i;
  }
  EXPECT_LT(solved.stddev[0], 13.0);
  EXPECT_GT(solved.reprojection_error, 0.1);
  EXPECT_LT(solved.reprojection_error, 1.0);
  EXPECT_SAYS(g_bench->solve(99).message, "no lens model 99");
}

TEST(Board, AFisheyeModelCanBeRequested) {
  const auto solved = g_bench->solve(SolveBoard::Request::EQUIDISTANT);
  ASSERT_TRUE(solved.success) << solved.message;
  EXPECT_EQ(solved.camera_info.distortion_model, "equidistant");
  EXPECT_EQ(solved.camera_info.D.size(), 4U);
  EXPECT_EQ(solved.stddev.size(), 8U);
}

TEST(Board, ALensOfViewsThatChangeMeanwhileIsRefused) {
  // An undo comes before the solver begins, while it runs, or after: so the delay is searched for.
  std::chrono::microseconds delay(1000);
  SolveBoard::Response solved;
  const auto showAndTakeAway = [] {
    g_bench->hold(intrinsics::randomPose(g_bench->random_));  // the status is newer than an undo
    ASSERT_TRUE(g_bench->showUntilEnough());
    ASSERT_TRUE(g_bench->takeAway());
  };
  const auto undoWhileSolving = [&] {
    showAndTakeAway();
    auto solving = std::async(std::launch::async,
                              [] { return g_bench->solve(SolveBoard::Request::AUTOMATIC); });
    const bool is_late = solving.wait_for(delay) == std::future_status::ready;
    EXPECT_TRUE(g_bench->trigger("undo").success);
    solved = solving.get();
    delay = is_late ? delay * 2 / 3 : delay * 2;
  };
  EXPECT_TRUE(Bench::repeatUntil(
      [&] { return solved.message == "the views were changed meanwhile: solve again"; },
      undoWhileSolving))
      << solved.message;
  EXPECT_FALSE(solved.success);
  EXPECT_SAYS(g_bench->trigger("commit").message, "solve it first");
  showAndTakeAway();
}

TEST(Board, CommitGivesTheLensToTheDriver) {
  const auto solved = g_bench->solve(SolveBoard::Request::K1);
  ASSERT_TRUE(solved.success) << solved.message;
  const auto committed = g_bench->trigger("commit");
  EXPECT_TRUE(committed.success);
  EXPECT_SAYS(committed.message, "its driver has it");
  EXPECT_EQ(g_bench->camera_info_.K, solved.camera_info.K);
  EXPECT_EQ(g_bench->camera_info_.D, solved.camera_info.D);
  EXPECT_EQ(g_bench->camera_info_.header.frame_id, "wiimote_1_optical_frame");

  g_bench->info_.shutdown();
  EXPECT_SAYS(g_bench->trigger("commit").message,
              "but nothing offers set_camera_info of wiimote_1:");
  // A lens of a view that was dropped is not used.
  EXPECT_TRUE(g_bench->trigger("undo").success);
  EXPECT_SAYS(g_bench->trigger("commit").message, "solve it first");
  EXPECT_TRUE(g_bench->trigger("cancel").success);
  EXPECT_FALSE(g_bench->trigger("commit").success);
  ASSERT_TRUE(Bench::repeatUntil([] { return g_bench->status().camera.empty(); },
                                 [] { ros::WallDuration(0.01).sleep(); }));
  EXPECT_EQ(g_bench->status().views, 0U);
}

TEST(Board, TheNextCalibrationStartsWithTheCommittedLens) {
  // A calibration needs another camera, of which no board was seen.
  const ros::Publisher other = g_bench->nh_.advertise<IrBlobArray>("wiimote_2/ir_blobs", 1);
  wiimote_tracker_msgs::StartCalibration::Request request;
  request.side_x = 2.5;
  const auto started =
      Bench::call<wiimote_tracker_msgs::StartCalibration>("calibration/start", request);
  ASSERT_TRUE(started.success) << started.message;
  // What was captured is saved with the lenses that a solver starts from.
  using wiimote_tracker_msgs::SaveSamples;
  ASSERT_TRUE(Bench::call<wiimote_tracker_msgs::StartWave>("calibration/start_wave").success);
  g_bench->stamp_ = ros::Time::now().toSec();  // an earlier image is none of the wave
  SaveSamples::Response saved;
  const auto isSaved = [&] {
    saved = Bench::call<SaveSamples>("calibration/save_samples");
    return saved.success != 0;
  };
  const Eigen::Isometry3d ahead(Eigen::Translation3d(0.0, 0.0, 1.0));
  ASSERT_TRUE(Bench::repeatUntil(isSaved, [&] { g_bench->hold(ahead); })) << saved.message;
  const auto cameras = samples::readSamplesFile(saved.path).recording.cameras;
  std::filesystem::remove_all(std::filesystem::path(saved.path).parent_path());
  ASSERT_EQ(cameras.size(), 2U);
  const geometry::Intrinsics usual;
  const geometry::Intrinsics& lens = cameras[0].sightings.intrinsics;
  const sensor_msgs::CameraInfo& committed = g_bench->camera_info_;  // of a test before
  ASSERT_EQ(committed.D.size(), 5U);
  EXPECT_NE(lens.fx, usual.fx);
  EXPECT_EQ(lens.fx, committed.K[0]);
  EXPECT_EQ(lens.fy, committed.K[4]);
  EXPECT_EQ(lens.cx, committed.K[2]);
  EXPECT_EQ(lens.cy, committed.K[5]);
  EXPECT_EQ(lens.distortion[0], committed.D[0]);
  EXPECT_EQ(cameras[1].sightings.name, "wiimote_2");
  EXPECT_EQ(cameras[1].sightings.intrinsics.fx, usual.fx);
  EXPECT_EQ(cameras[1].sightings.intrinsics.distortion, usual.distortion);
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "board_services_test");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  wiimote_tracker::g_bench = std::make_unique<wiimote_tracker::Bench>();
  const int result = RUN_ALL_TESTS();
  wiimote_tracker::g_bench.reset();
  return result;
}
