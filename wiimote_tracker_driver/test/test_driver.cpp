// The driver as its users see it, node and nodelet alike, with a virtual remote on its socket.
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <tf2_msgs/TFMessage.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace wiimote_tracker::driver {
namespace {

using virtual_wiimote::Senses;
using virtual_wiimote::Server;
using wiimote_tracker_msgs::IrBlobArray;

const std::string kIdentity = "00:1f:32:00:00:07";

/// A virtual remote that senses the same thing a hundred times a second until told otherwise.
class Remote {
 public:
  explicit Remote(const std::string& path)
      : server(path, kIdentity, virtual_wiimote::Device::Options()), thread_([this] { run(); }) {}
  ~Remote() {
    stop_ = true;
    thread_.join();
  }

  void sense(const Senses& senses) {
    const std::lock_guard<std::mutex> lock(mutex_);
    senses_ = senses;
  }

  Server server;

 private:
  void run() {
    while (!stop_) {
      Senses senses;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        senses = senses_;
      }
      server.sample(senses);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  std::mutex mutex_;
  Senses senses_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class DriverTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::string path;
    ASSERT_TRUE(ros::NodeHandle("~").getParam("socket", path));
    remote = std::make_unique<Remote>(path);
  }
  static void TearDownTestSuite() { remote.reset(); }

  void SetUp() override { remote->sense(Senses()); }

  /// Spins until the condition holds; false when it does not within 20 s.
  template <typename Condition>
  static bool eventually(Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline || !ros::ok())
        return false;
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
    return true;
  }

  /// All messages of a topic since this was made.
  template <typename M>
  struct Recorder {
    explicit Recorder(const std::string& topic)
        : subscriber(
              ros::NodeHandle("wiimote_1")
                  .subscribe<M>(topic, 1000, [this](const boost::shared_ptr<const M>& message) {
                    messages.push_back(*message);
                  })) {}
    std::vector<M> messages;
    ros::Subscriber subscriber;
  };

  static Senses lights(const std::vector<virtual_wiimote::Light>& lights) {
    Senses senses;
    senses.lights = lights;
    return senses;
  }

  static std::unique_ptr<Remote> remote;
};

std::unique_ptr<Remote> DriverTest::remote;

TEST_F(DriverTest, BlobsAreInImageConvention) {
  remote->sense(lights({{291, 69, 3, 9}, {1023, 767, 1, 8}, {0, 100, 15, 7}}));
  Recorder<IrBlobArray> blobs("ir_blobs");
  ASSERT_TRUE(eventually(
      [&] { return !blobs.messages.empty() && blobs.messages.back().blobs.size() == 3; }));
  const IrBlobArray& message = blobs.messages.back();
  EXPECT_EQ("wiimote_1_optical_frame", message.header.frame_id);
  EXPECT_EQ("wiimote_1", message.camera);
  EXPECT_EQ(kIdentity, message.identity);
  EXPECT_EQ(1024u, message.width);
  EXPECT_EQ(768u, message.height);
  EXPECT_EQ(4u, message.max_blobs);
  EXPECT_EQ(+IrBlobArray::IR_MODE_EXTENDED, message.ir_mode);
  EXPECT_TRUE(std::isnan(message.stamp_stddev));
  EXPECT_EQ(291, message.blobs[0].x);
  EXPECT_EQ(698, message.blobs[0].y);
  EXPECT_EQ(3, message.blobs[0].size);
  EXPECT_EQ(0, message.blobs[0].slot);
  EXPECT_TRUE(std::isnan(message.blobs[0].intensity));
  EXPECT_TRUE(message.blobs[0].bounding_box.empty());
  EXPECT_EQ(1023, message.blobs[1].x);
  EXPECT_EQ(0, message.blobs[1].y);
  EXPECT_EQ(0, message.blobs[2].x);
  EXPECT_EQ(667, message.blobs[2].y);
  EXPECT_EQ(15, message.blobs[2].size);
  EXPECT_EQ(2, message.blobs[2].slot);
}

TEST_F(DriverTest, SlotStaysWithTheLightThatIsLeft) {
  Recorder<IrBlobArray> blobs("ir_blobs");
  const auto sees = [&](std::size_t count) {
    return !blobs.messages.empty() && blobs.messages.back().blobs.size() == count;
  };
  ASSERT_TRUE(eventually([&] { return sees(0); }));
  remote->sense(lights({{300, 100, 2, 2}, {500, 100, 2, 1}}));
  ASSERT_TRUE(eventually([&] { return sees(2); }));
  remote->sense(lights({{500, 100, 2, 1}}));
  ASSERT_TRUE(eventually([&] { return sees(1); }));
  EXPECT_EQ(500, blobs.messages.back().blobs[0].x);
  EXPECT_EQ(1, blobs.messages.back().blobs[0].slot);
}

TEST_F(DriverTest, DarkImagesAreEmptyArraysNotSilence) {
  Recorder<IrBlobArray> blobs("ir_blobs");
  // The first ones may still show the lights of the test before.
  const auto last_are_empty = [&](std::size_t count) {
    return blobs.messages.size() >= count &&
           std::all_of(blobs.messages.end() - static_cast<std::ptrdiff_t>(count),
                       blobs.messages.end(), [](const IrBlobArray& m) { return m.blobs.empty(); });
  };
  EXPECT_TRUE(eventually([&] { return last_are_empty(20); }));
}

TEST_F(DriverTest, TimesAndCounters) {
  const ros::Time before = ros::Time::now();
  Recorder<IrBlobArray> blobs("ir_blobs");
  ASSERT_TRUE(eventually([&] { return blobs.messages.size() >= 20; }));
  const ros::Time after = ros::Time::now();
  for (std::size_t i = 0; i < blobs.messages.size(); ++i) {
    const IrBlobArray& message = blobs.messages[i];
    EXPECT_LT(before, message.arrival);
    EXPECT_LT(message.arrival, after);
    // The launch file sets the latency to 20 ms.
    EXPECT_NEAR(0.02, (message.arrival - message.header.stamp).toSec(), 1e-6);
    if (i > 0) {
      EXPECT_EQ(blobs.messages[i - 1].frame + 1, message.frame);
      EXPECT_LT(blobs.messages[i - 1].header.stamp, message.header.stamp);
    }
  }
}

TEST_F(DriverTest, AccelerationInMetresPerSecondSquared) {
  Recorder<sensor_msgs::Imu> imu("imu/data_raw");
  const auto reads = [&](double x, double y, double z) {
    if (imu.messages.empty())
      return false;
    const auto& a = imu.messages.back().linear_acceleration;
    // The converter's steps are below 0.2 m/s^2.
    return std::abs(a.x - x) < 0.2 && std::abs(a.y - y) < 0.2 && std::abs(a.z - z) < 0.2;
  };
  EXPECT_TRUE(eventually([&] { return reads(0.0, 0.0, 9.80665); })) << "lying, buttons up";
  Senses senses;
  senses.acceleration = {0.6, -0.8, 0.0};
  remote->sense(senses);
  EXPECT_TRUE(eventually([&] { return reads(5.884, -7.845, 0.0); }));
  const sensor_msgs::Imu& message = imu.messages.back();
  EXPECT_EQ("wiimote_1_imu_frame", message.header.frame_id);
  EXPECT_EQ(-1.0, message.orientation_covariance[0]);
  EXPECT_EQ(-1.0, message.angular_velocity_covariance[0]);
  EXPECT_NEAR(0.01, message.linear_acceleration_covariance[4], 1e-9);
}

TEST_F(DriverTest, StaticTransformFromOpticalToImu) {
  Recorder<tf2_msgs::TFMessage> transforms("/tf_static");
  ASSERT_TRUE(eventually([&] { return !transforms.messages.empty(); }));
  const auto& transform = transforms.messages[0].transforms.at(0);
  EXPECT_EQ("wiimote_1_optical_frame", transform.header.frame_id);
  EXPECT_EQ("wiimote_1_imu_frame", transform.child_frame_id);
  // Columns of the rotation matrix: where the remote's left, rear and up point in the image.
  const auto& q = transform.transform.rotation;
  EXPECT_NEAR(-1.0, 1 - 2 * (q.y * q.y + q.z * q.z), 1e-12);  // left: -x
  EXPECT_NEAR(-1.0, 2 * (q.y * q.z + q.x * q.w), 1e-12);      // rear: -z
  EXPECT_NEAR(-1.0, 2 * (q.y * q.z - q.x * q.w), 1e-12);      // up: -y
}

TEST_F(DriverTest, CameraInfoGoesWithEachImageAndCanBeSet) {
  Recorder<IrBlobArray> blobs("ir_blobs");
  Recorder<sensor_msgs::CameraInfo> infos("camera_info");
  ASSERT_TRUE(eventually([&] { return infos.messages.size() >= 10; }));
  const sensor_msgs::CameraInfo uncalibrated = infos.messages.back();
  EXPECT_EQ(1024u, uncalibrated.width);
  EXPECT_EQ(768u, uncalibrated.height);
  EXPECT_EQ(0.0, uncalibrated.K[0]);
  EXPECT_EQ("wiimote_1_optical_frame", uncalibrated.header.frame_id);
  EXPECT_TRUE(eventually([&] {
    for (const IrBlobArray& message : blobs.messages) {
      if (message.header.stamp == uncalibrated.header.stamp)
        return true;
    }
    return false;
  })) << "same stamp as an image";

  sensor_msgs::SetCameraInfo set;
  set.request.camera_info.width = 1024;
  set.request.camera_info.height = 768;
  set.request.camera_info.distortion_model = "plumb_bob";
  set.request.camera_info.D = {0.01, -0.02, 0, 0, 0};
  set.request.camera_info.K = {{1330, 0, 512, 0, 1331, 384, 0, 0, 1}};
  set.request.camera_info.R = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  set.request.camera_info.P = {{1330, 0, 512, 0, 0, 1331, 384, 0, 0, 0, 1, 0}};
  ASSERT_TRUE(ros::service::call("/wiimote_1/set_camera_info", set));
  EXPECT_TRUE(set.response.success) << set.response.status_message;
  ASSERT_TRUE(eventually([&] { return infos.messages.back().K[4] == 1331; }));
  EXPECT_EQ(-0.02, infos.messages.back().D.at(1));

  std::string file;
  ASSERT_TRUE(ros::NodeHandle("~").getParam("camera_info_file", file));
  EXPECT_TRUE(std::ifstream(file).good()) << "saved where camera_info_url says";
}

TEST_F(DriverTest, DiagnosticsTellHowItIs) {
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  diagnostic_msgs::DiagnosticStatus found;
  ASSERT_TRUE(eventually([&] {
    for (const auto& array : diagnostics.messages) {
      for (const auto& status : array.status) {
        if (status.name.find("Wii Remote wiimote_1") != std::string::npos &&
            status.hardware_id == kIdentity &&
            status.level != diagnostic_msgs::DiagnosticStatus::ERROR)
          found = status;
      }
    }
    return !found.name.empty();
  }));
  std::map<std::string, std::string> values;
  for (const auto& value : found.values)
    values[value.key] = value.value;
  EXPECT_EQ("streaming", values["Link"]);
  EXPECT_EQ(0u, values["Device"].find("virtual:"));
  EXPECT_EQ("none", values["Kernel driver"]);
  EXPECT_EQ("160", values["Battery (raw)"]);
  EXPECT_GT(std::atof(values["Rate [Hz]"].c_str()), 1.0);
  EXPECT_EQ(1u, values.count("Longest gap [ms]"));
  EXPECT_EQ(1u, values.count("Gaps over 50 ms"));
  EXPECT_EQ(1u, values.count("Reconnects"));
}

TEST_F(DriverTest, UnplugAndReplugIsANewEpochOfTheSameStream) {
  remote->sense(lights({{291, 69, 3, 9}}));
  Recorder<IrBlobArray> blobs("ir_blobs");
  ASSERT_TRUE(eventually([&] { return !blobs.messages.empty(); }));
  remote->server.setPresent(false);

  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  EXPECT_TRUE(eventually([&] {
    for (const auto& array : diagnostics.messages) {
      for (const auto& status : array.status) {
        if (status.level == diagnostic_msgs::DiagnosticStatus::ERROR &&
            status.message.find("no virtual Wii Remote listens") != std::string::npos)
          return true;
      }
    }
    return false;
  })) << "diagnostics say what is missing";

  const IrBlobArray before = blobs.messages.back();
  const std::size_t count = blobs.messages.size();
  remote->server.setPresent(true);
  ASSERT_TRUE(eventually(
      [&] { return blobs.messages.size() > count && !blobs.messages.back().blobs.empty(); }));
  const IrBlobArray& first = blobs.messages[count];
  EXPECT_EQ(before.clock_epoch + 1, first.clock_epoch);
  EXPECT_EQ(before.frame + 1, first.frame);
  EXPECT_EQ(698, blobs.messages.back().blobs[0].y);
}

// The last test: the driver does not come back.
TEST_F(DriverTest, ShutDownSwitchesTheRemoteOff) {
  ASSERT_TRUE(eventually([&] { return remote->server.connected(); }));
  ASSERT_TRUE(eventually([&] { return remote->server.leds() == 0x4; })) << "as configured";
  ASSERT_EQ(0, std::system("rosnode kill /wiimote_1/driver > /dev/null"));
  EXPECT_TRUE(eventually([&] { return !remote->server.connected(); }));
  EXPECT_EQ(0x0, remote->server.leds());
}

}  // namespace
}  // namespace wiimote_tracker::driver

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_driver");
  const ros::NodeHandle nh;  // keeps ROS running
  return RUN_ALL_TESTS();
}
