// The driver as a node and as a nodelet, with a virtual remote on its socket. More than 400 lines,
// because all tests share one driver; the last ones unplug its remote and end it.
#include "driver_helpers.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/Joy.h>
#include <sensor_msgs/JoyFeedbackArray.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <tf2_msgs/TFMessage.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <random>

namespace wiimote_tracker::driver {
namespace {

using virtual_wiimote::Senses;
using wiimote_tracker_msgs::IrBlobArray;

class DriverTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    remote_ = std::make_unique<Remote>(parameter("files") + "_1.sock", kIdentity);
  }
  static void TearDownTestSuite() { remote_.reset(); }

  void SetUp() override { remote_->sense(Senses()); }

  static std::unique_ptr<Remote> remote_;
};

std::unique_ptr<Remote> DriverTest::remote_;

/// A time of the steady clock on the ROS clock. Both are read again when this process was stopped
/// meanwhile.
ros::Time rosTimeOf(double time) {
  double before = 0.0;
  ros::Time now;
  do {
    before = steadyNow();
    now = ros::Time::now();
  } while (steadyNow() - before > 0.0002);
  return now - ros::Duration(before - time);
}

TEST_F(DriverTest, BlobsFollowTheImageConvention) {
  remote_->sense(lights({{291, 69, 3, 9}, {1023, 767, 1, 8}, {0, 100, 15, 7}}));
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  ASSERT_TRUE(spinUntil(
      [&] { return !blobs.messages.empty() && blobs.messages.back().blobs.size() == 3; }));
  const IrBlobArray& message = blobs.messages.back();
  EXPECT_EQ("wiimote_1_optical_frame", message.header.frame_id);
  EXPECT_EQ("wiimote_1", message.camera);
  EXPECT_EQ(kIdentity, message.identity);
  EXPECT_EQ(1024u, message.width);
  EXPECT_EQ(768u, message.height);
  EXPECT_EQ(4u, message.max_blobs);
  EXPECT_EQ(+IrBlobArray::IR_MODE_EXTENDED, message.ir_mode);
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

TEST_F(DriverTest, ARemainingLightKeepsItsSlot) {
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  const auto sees = [&](std::size_t count) {
    return !blobs.messages.empty() && blobs.messages.back().blobs.size() == count;
  };
  ASSERT_TRUE(spinUntil([&] { return sees(0); }));
  remote_->sense(lights({{300, 100, 2, 2}, {500, 100, 2, 1}}));
  ASSERT_TRUE(spinUntil([&] { return sees(2); }));
  remote_->sense(lights({{500, 100, 2, 1}}));
  ASSERT_TRUE(spinUntil([&] { return sees(1); }));
  EXPECT_EQ(500, blobs.messages.back().blobs[0].x);
  EXPECT_EQ(1, blobs.messages.back().blobs[0].slot);
}

TEST_F(DriverTest, DarkImagesAreEmptyArrays) {
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  // The first ones may still show the lights of the test before.
  const auto last_are_empty = [&](std::size_t count) {
    return blobs.messages.size() >= count &&
           std::all_of(blobs.messages.end() - static_cast<std::ptrdiff_t>(count),
                       blobs.messages.end(), [](const IrBlobArray& m) { return m.blobs.empty(); });
  };
  EXPECT_TRUE(spinUntil([&] { return last_are_empty(20); }));
}

// Reports are delayed by a soft jitter as it was measured with real remotes. Each image shows its
// own number, so that the test knows when it was taken.
TEST_F(DriverTest, StampsFollowTheExposuresNotTheArrivals) {
  constexpr std::uint64_t kNumbers = 1000;
  const auto jitter = std::make_shared<std::mt19937>(17);
  remote_->play([jitter](std::uint64_t n) {
    std::normal_distribution<double> delay(Remote::kDelay, 0.0024);
    return Remote::Instant{lights({{static_cast<double>(n % kNumbers), 384, 3, 9}}),
                           std::max(0.0, delay(*jitter))};
  });
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  ASSERT_TRUE(spinUntil([&] { return blobs.messages.size() >= 600; }));

  // The last 300, after the clock has settled.
  const ros::Time ros_start = rosTimeOf(remote_->exposure(0));
  const std::uint64_t thousands =
      static_cast<std::uint64_t>((steadyNow() - remote_->exposure(0)) / Remote::kPeriod) / kNumbers;
  std::vector<double> stamp_errors;
  std::vector<double> stamp_stddevs;
  std::vector<double> arrival_errors;
  for (auto message = blobs.messages.end() - 300; message != blobs.messages.end(); ++message) {
    if (message->blobs.empty())
      continue;
    const double age = (message->arrival - ros_start).toSec();
    std::uint64_t n = thousands * kNumbers + static_cast<std::uint64_t>(message->blobs[0].x);
    while (static_cast<double>(n) * Remote::kPeriod > age)
      n -= kNumbers;
    const double exposure = static_cast<double>(n) * Remote::kPeriod;
    arrival_errors.push_back(age - exposure);
    stamp_errors.push_back((message->header.stamp - ros_start).toSec() - exposure);
    stamp_stddevs.push_back(message->stamp_stddev);
    EXPECT_GT(message->stamp_stddev, 0.0);
  }
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  // Median distance from the median, so that a few stalls of this computer do not count.
  const auto spread = [&](std::vector<double> v) {
    const double middle = median(v);
    for (double& x : v)
      x = std::abs(x - middle);
    return median(v);
  };
  ASSERT_GT(stamp_errors.size(), 200u);
  EXPECT_GT(spread(arrival_errors), 0.001) << "there must be jitter";
  EXPECT_LT(spread(stamp_errors), 0.4 * spread(arrival_errors));
  // A stall widens the standard deviation of the images it delays, as it should.
  EXPECT_LT(median(stamp_stddevs), Remote::kPeriod);
  // Latency (20 ms by the launch file) is subtracted. A busy computer delays all arrivals.
  EXPECT_LT(median(stamp_errors), median(arrival_errors) - 0.010);
}

// Nobody sees the images at first.
TEST_F(DriverTest, ALateSubscriberFindsTheClockInStep) {
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  ASSERT_TRUE(spinUntil([&] {
    return values(driverStatus(diagnostics))["exposure clock"] == "in step" &&
           remote_->server.connected();
  }));
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  const auto age = [](const IrBlobArray& message) {
    return (message.arrival - message.header.stamp).toSec() - 0.02;  // parameter latency
  };
  // The first one that no stall of this computer delayed: that widens the standard deviation, as it
  // should. A clock that only begins has an age of 0.
  const auto first = [&] {
    double least = age(blobs.messages.front());
    for (const IrBlobArray& message : blobs.messages)
      least = std::min(least, age(message));
    return *std::find_if(blobs.messages.begin(), blobs.messages.end(), [&](const IrBlobArray& m) {
      return age(m) <= least + 0.3 * Remote::kPeriod;
    });
  };
  ASSERT_TRUE(spinUntil([&] {
    return blobs.messages.size() >= 20 && first().stamp_stddev < 0.3 * Remote::kPeriod;
  })) << blobs.messages.size()
      << " images";
  EXPECT_LT(std::abs(age(first())), Remote::kPeriod);
  for (std::size_t i = 1; i < blobs.messages.size(); ++i)
    EXPECT_GT(blobs.messages[i].header.stamp, blobs.messages[i - 1].header.stamp);
}

TEST_F(DriverTest, StampsIncreaseAndImagesAreCounted) {
  const ros::Time before = ros::Time::now();
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  ASSERT_TRUE(spinUntil([&] { return blobs.messages.size() >= 50; }));
  const ros::Time after = ros::Time::now();
  for (std::size_t i = 0; i < blobs.messages.size(); ++i) {
    const IrBlobArray& message = blobs.messages[i];
    EXPECT_LT(before, message.arrival);
    EXPECT_LT(message.arrival, after);
    if (i > 0) {
      EXPECT_LT(blobs.messages[i - 1].frame, message.frame);
      EXPECT_LT(blobs.messages[i - 1].header.stamp, message.header.stamp);
      EXPECT_LE(blobs.messages[i - 1].arrival, message.arrival);
    }
  }
}

TEST_F(DriverTest, AccelerationInMetresPerSecondSquared) {
  Recorder<sensor_msgs::Imu> imu("/wiimote_1/imu/data_raw");
  const auto reads = [&](double x, double y, double z) {
    if (imu.messages.empty())
      return false;
    const auto& a = imu.messages.back().linear_acceleration;
    // The converter's steps are below 0.2 m/s^2.
    return std::abs(a.x - x) < 0.2 && std::abs(a.y - y) < 0.2 && std::abs(a.z - z) < 0.2;
  };
  EXPECT_TRUE(spinUntil([&] { return reads(0.0, 0.0, 9.80665); })) << "lying, buttons up";
  Senses senses;
  senses.acceleration = {0.6, -0.8, 0.0};
  remote_->sense(senses);
  EXPECT_TRUE(spinUntil([&] { return reads(5.884, -7.845, 0.0); }));
  const sensor_msgs::Imu& message = imu.messages.back();
  EXPECT_EQ("wiimote_1_imu_frame", message.header.frame_id);
  EXPECT_EQ(-1.0, message.orientation_covariance[0]);
  EXPECT_EQ(-1.0, message.angular_velocity_covariance[0]);
  EXPECT_NEAR(0.01, message.linear_acceleration_covariance[4], 1e-9);
}

TEST_F(DriverTest, StaticTransformFromOpticalToImu) {
  Recorder<tf2_msgs::TFMessage> transforms("/tf_static");
  geometry_msgs::TransformStamped transform;
  ASSERT_TRUE(spinUntil([&] {
    for (const auto& message : transforms.messages) {
      for (const auto& candidate : message.transforms) {
        if (candidate.header.frame_id == "wiimote_1_optical_frame")
          transform = candidate;
      }
    }
    return !transform.child_frame_id.empty();
  }));
  EXPECT_EQ("wiimote_1_imu_frame", transform.child_frame_id);
  // Columns of the rotation matrix: directions of the remote's left, rear and up in the image.
  const auto& q = transform.transform.rotation;
  EXPECT_NEAR(-1.0, 1 - 2 * (q.y * q.y + q.z * q.z), 1e-12);  // left: -x
  EXPECT_NEAR(-1.0, 2 * (q.y * q.z + q.x * q.w), 1e-12);      // rear: -z
  EXPECT_NEAR(-1.0, 2 * (q.y * q.z - q.x * q.w), 1e-12);      // up: -y
}

sensor_msgs::CameraInfo calibration() {
  sensor_msgs::CameraInfo info;
  info.width = 1024;
  info.height = 768;
  info.distortion_model = "plumb_bob";
  info.D = {0.01, -0.02, 0, 0, 0};
  info.K = {{1330, 0, 512, 0, 1331, 384, 0, 0, 1}};
  info.R = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  info.P = {{1330, 0, 512, 0, 0, 1331, 384, 0, 0, 0, 1, 0}};
  return info;
}

TEST_F(DriverTest, CameraInfoComesWithEachImageAndCanBeSet) {
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  Recorder<sensor_msgs::CameraInfo> infos("/wiimote_1/camera_info");
  // One that came after the images, too, are connected.
  ASSERT_TRUE(spinUntil([&] {
    return infos.messages.size() >= 10 && blobs.any() &&
           infos.last().header.stamp >= blobs.messages.front().header.stamp;
  }));
  const sensor_msgs::CameraInfo uncalibrated = infos.messages.back();
  EXPECT_EQ(1024u, uncalibrated.width);
  EXPECT_EQ(768u, uncalibrated.height);
  EXPECT_EQ(0.0, uncalibrated.K[0]);
  EXPECT_EQ("wiimote_1_optical_frame", uncalibrated.header.frame_id);
  EXPECT_TRUE(spinUntil([&] {
    for (const IrBlobArray& message : blobs.messages) {
      if (message.header.stamp == uncalibrated.header.stamp)
        return true;
    }
    return false;
  })) << "same stamp as an image";

  sensor_msgs::SetCameraInfo set;
  set.request.camera_info = calibration();
  ASSERT_TRUE(ros::service::call("/wiimote_1/set_camera_info", set));
  EXPECT_TRUE(set.response.success) << set.response.status_message;
  ASSERT_TRUE(spinUntil([&] { return infos.messages.back().K[4] == 1331; }));
  EXPECT_EQ(-0.02, infos.messages.back().D.at(1));

  EXPECT_TRUE(std::ifstream(parameter("files") + "_1.yaml").good())
      << "saved where camera_info_url says";

  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  const auto is_told_empty = [&] {
    return driverStatus(diagnostics).message.find("_1.yaml is empty") != std::string::npos;
  };
  std::ofstream(parameter("files") + "_1.yaml").close();  // as a full disk leaves it
  EXPECT_TRUE(spinUntil(is_told_empty));
  ASSERT_TRUE(ros::service::call("/wiimote_1/set_camera_info", set));
  EXPECT_TRUE(spinUntil([&] { return !is_told_empty(); }));
}

TEST_F(DriverTest, NonsenseAsCalibrationIsToldAndNotPublished) {
  Recorder<sensor_msgs::CameraInfo> infos("/wiimote_1/camera_info");
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  const auto is_told = [&](const std::string& words) {
    return driverStatus(diagnostics).message.find(words) != std::string::npos;
  };
  const sensor_msgs::CameraInfo good = calibration();
  const auto isToldOf = [&](const std::function<void(sensor_msgs::CameraInfo&)>& spoil) {
    sensor_msgs::SetCameraInfo set;
    set.request.camera_info = good;
    spoil(set.request.camera_info);
    EXPECT_TRUE(ros::service::call("/wiimote_1/set_camera_info", set));
    return spinUntil([&] { return is_told("_1.yaml is unusable: "); });
  };
  const auto isGood = [&] {
    sensor_msgs::SetCameraInfo set;
    set.request.camera_info = good;
    EXPECT_TRUE(ros::service::call("/wiimote_1/set_camera_info", set));
    return spinUntil([&] { return !is_told("unusable") && infos.last().K == good.K; });
  };
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(isToldOf([](auto& info) { info.K.fill(kNaN); }));
  EXPECT_TRUE(is_told("focal length")) << driverStatus(diagnostics).message;
  infos.messages.clear();
  ASSERT_TRUE(spinUntil([&] { return infos.messages.size() >= 10; }));
  EXPECT_EQ(0.0, infos.last().K[0]) << "not calibrated";
  EXPECT_EQ(1024u, infos.last().width);
  EXPECT_TRUE(isGood());
  EXPECT_TRUE(isToldOf([](auto& info) { info.height = 0; }));
  EXPECT_TRUE(is_told("1024 x 0 pixels")) << driverStatus(diagnostics).message;
  EXPECT_TRUE(isGood());
  EXPECT_TRUE(isToldOf([](auto& info) { info.distortion_model = "rubber"; }));
  EXPECT_TRUE(is_told("'rubber'")) << driverStatus(diagnostics).message;
  EXPECT_TRUE(isGood());
  EXPECT_TRUE(isToldOf([](auto& info) { info.D[1] = kNaN; }));
  EXPECT_TRUE(isGood());
}

TEST_F(DriverTest, FactoryCalibrationIsPublished) {
  Recorder<sensor_msgs::CameraInfo> infos("/wiimote_1/factory/camera_info");
  ASSERT_TRUE(spinUntil([&] { return infos.any(); })) << "latched";
  // The mean of the four points of the virtual remote, (525.5, 353.75) with y up.
  EXPECT_EQ(525.5, infos.last().K[2]);
  EXPECT_EQ(413.25, infos.last().K[5]);
  EXPECT_EQ(0.0, infos.last().K[0]) << "no focal length";
  EXPECT_EQ("wiimote_1_optical_frame", infos.last().header.frame_id);
}

TEST_F(DriverTest, ButtonsAsJoy) {
  Recorder<sensor_msgs::Joy> joy("/wiimote_1/joy");
  ASSERT_TRUE(spinUntil([&] { return joy.any(); })) << "latched";
  EXPECT_EQ(std::vector<int>(11, 0), joy.last().buttons);
  Senses senses;
  senses.buttons = 0x0008 | 0x1000;  // A and plus
  remote_->sense(senses);
  const std::vector<int> pressed{0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(spinUntil([&] { return joy.last().buttons == pressed; }));
  EXPECT_TRUE(joy.last().axes.empty());
  remote_->sense(Senses());
  EXPECT_TRUE(spinUntil([&] { return joy.last().buttons == std::vector<int>(11, 0); }));
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  ASSERT_TRUE(spinUntil([&] { return blobs.messages.size() >= 20; }));
  EXPECT_LE(joy.messages.size(), 4u) << "changes only";
}

TEST_F(DriverTest, FeedbackLightsLedsAndRumblesForAWhile) {
  ros::Publisher publisher =
      ros::NodeHandle().advertise<sensor_msgs::JoyFeedbackArray>("/wiimote_1/joy/set_feedback", 10);
  ASSERT_TRUE(spinUntil([&] { return publisher.getNumSubscribers() > 0; }));
  ASSERT_TRUE(spinUntil([&] { return remote_->server.leds() == 0x4; })) << "as configured";
  EXPECT_FALSE(remote_->server.rumble());
  const auto feedback = [](int type, int id, float intensity) {
    sensor_msgs::JoyFeedback f;
    f.type = static_cast<std::uint8_t>(type);
    f.id = static_cast<std::uint8_t>(id);
    f.intensity = intensity;
    return f;
  };
  sensor_msgs::JoyFeedbackArray message;
  message.array = {feedback(sensor_msgs::JoyFeedback::TYPE_LED, 0, 1.0f),
                   feedback(sensor_msgs::JoyFeedback::TYPE_LED, 2, 0.0f),
                   feedback(sensor_msgs::JoyFeedback::TYPE_LED, 7, 1.0f),
                   feedback(sensor_msgs::JoyFeedback::TYPE_BUZZER, 0, 1.0f)};
  publisher.publish(message);
  EXPECT_TRUE(spinUntil([&] { return remote_->server.leds() == 0x1; }));
  message.array = {feedback(sensor_msgs::JoyFeedback::TYPE_RUMBLE, 0, 1.0f)};
  EXPECT_TRUE(spinUntil([&] {  // again, since this process may not look while it lasts
    publisher.publish(message);
    return remote_->server.rumble();
  }));
  EXPECT_TRUE(spinUntil([&] { return !remote_->server.rumble(); })) << "after rumble_max";
  EXPECT_EQ(0x1, remote_->server.leds());
  message.array = {feedback(sensor_msgs::JoyFeedback::TYPE_LED, 0, 0.0f),
                   feedback(sensor_msgs::JoyFeedback::TYPE_LED, 2, 1.0f)};
  publisher.publish(message);
  EXPECT_TRUE(spinUntil([&] { return remote_->server.leds() == 0x4; }));
}

TEST_F(DriverTest, BatteryIsPublishedWithAWarning) {
  Recorder<sensor_msgs::BatteryState> battery("/wiimote_1/battery");
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  ASSERT_TRUE(spinUntil([&] { return battery.any(); })) << "latched";
  EXPECT_EQ(1.0f, battery.last().percentage);
  EXPECT_TRUE(battery.last().present);
  EXPECT_TRUE(std::isnan(battery.last().voltage));
  EXPECT_TRUE(std::isnan(battery.last().temperature));
  EXPECT_EQ("wiimote_1", battery.last().location);
  EXPECT_EQ(kIdentity, battery.last().serial_number);
  remote_->server.setBattery(0x10);
  EXPECT_TRUE(spinUntil([&] { return battery.last().percentage < 0.9f; }));
  EXPECT_NEAR(2.46 * 16 / 255 - 0.013, battery.last().percentage, 1e-6);
  EXPECT_TRUE(spinUntil([&] {
    return driverStatus(diagnostics).message.find("batteries are nearly empty") !=
           std::string::npos;
  }));
  EXPECT_EQ("16", values(driverStatus(diagnostics))["battery (raw)"]);
  remote_->server.setBattery(0xa0);
  EXPECT_TRUE(spinUntil([&] { return battery.last().percentage == 1.0f; }));
}

/// Sets text parameters of the running driver. @returns the settings that are then in use.
std::map<std::string, std::string> set(
    const std::vector<std::pair<std::string, std::string>>& texts) {
  dynamic_reconfigure::Reconfigure call;
  for (const auto& text : texts) {
    dynamic_reconfigure::StrParameter parameter;
    parameter.name = text.first;
    parameter.value = text.second;
    call.request.config.strs.push_back(parameter);
  }
  EXPECT_TRUE(ros::service::call("/wiimote_1/driver/set_parameters", call));
  std::map<std::string, std::string> used;
  for (const auto& text : call.response.config.strs)
    used[text.name] = text.value;
  return used;
}

TEST_F(DriverTest, SensitivityChangesWithoutLosingTheStream) {
  remote_->sense(lights({{300, 100, 3, 0.05}}));
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  const auto sees = [&](std::size_t count) {
    return blobs.any() && blobs.last().blobs.size() == count;
  };
  ASSERT_TRUE(spinUntil([&] { return sees(1); }));
  EXPECT_EQ("wii_1", set({{"ir_sensitivity", "wii_1"}})["ir_sensitivity"]);
  EXPECT_TRUE(spinUntil([&] { return sees(0); })) << "too dim for the least sensitivity";
  set({{"ir_sensitivity", "custom"},
       {"ir_sensitivity_block1", "00 00 00 00 00 00 90 00 41"},
       {"ir_sensitivity_block2", "40 00"}});
  EXPECT_TRUE(spinUntil([&] { return sees(1); }));
  EXPECT_EQ(blobs.messages.front().clock_epoch, blobs.last().clock_epoch);

  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  EXPECT_TRUE(spinUntil([&] {
    return values(driverStatus(diagnostics))["IR sensitivity"] ==
           "custom: 00 00 00 00 00 00 90 00 41 / 40 00";
  }));
  EXPECT_EQ("wii_5", set({{"ir_sensitivity", "wii_5"}})["ir_sensitivity"]);
}

TEST_F(DriverTest, AnUnknownSettingIsRefused) {
  EXPECT_EQ("wii_5", set({{"ir_sensitivity", "bright"}})["ir_sensitivity"]);
  auto used = set({{"ir_sensitivity", "custom"}, {"ir_sensitivity_block1", "12 34"}});
  EXPECT_EQ("wii_5", used["ir_sensitivity"]);
  std::string stored;
  ASSERT_TRUE(ros::param::get("/wiimote_1/driver/ir_sensitivity", stored));
  EXPECT_EQ("wii_5", stored);
}

TEST_F(DriverTest, LedsCanBeChanged) {
  const auto set_leds = [](int leds) {
    dynamic_reconfigure::Reconfigure call;
    call.request.config.ints.resize(1);
    call.request.config.ints[0].name = "leds";
    call.request.config.ints[0].value = leds;
    EXPECT_TRUE(ros::service::call("/wiimote_1/driver/set_parameters", call));
  };
  set_leds(-1);
  EXPECT_TRUE(spinUntil([&] { return remote_->server.leds() == 0x1; })) << "wiimote_1";
  set_leds(4);
  EXPECT_TRUE(spinUntil([&] { return remote_->server.leds() == 0x4; }));
}

TEST_F(DriverTest, DiagnosticsDescribeTheState) {
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  ASSERT_TRUE(spinUntil([&] {
    const auto status = driverStatus(diagnostics);
    auto value = values(status);
    // After a stall of this computer it takes a while to be like this.
    return status.hardware_id == kIdentity &&
           status.level != diagnostic_msgs::DiagnosticStatus::ERROR &&
           value["link"] == "streaming" && std::atof(value["rate [Hz]"].c_str()) > 1.0 &&
           std::abs(std::atof(value["period [ms]"].c_str()) - 10.035) < 0.1;
  }));
  auto value = values(driverStatus(diagnostics));
  EXPECT_EQ("streaming", value["link"]);
  EXPECT_EQ(0u, value["device"].find("virtual:"));
  EXPECT_EQ("none", value["kernel driver"]);
  EXPECT_EQ("160", value["battery (raw)"]);
  EXPECT_EQ("extended", value["IR mode"]);
  EXPECT_EQ("wii_5", value["IR sensitivity"]);
  EXPECT_EQ("525.5, 413.2", value["factory principal point [px]"]);
  EXPECT_EQ(parameter("files") + "_1.wiirec", value["recording"]);
  EXPECT_GT(std::atof(value["rate [Hz]"].c_str()), 1.0);
  EXPECT_NEAR(10.035, std::atof(value["period [ms]"].c_str()), 0.1);
  for (const char* key :
       {"longest gap [ms]", "gaps over 50 ms", "reconnects", "restorations", "last restoration",
        "exposure clock", "stamp standard deviation [ms]", "jitter [ms]", "dropped images",
        "stale images", "steps of the system clock", "reader priority"})
    EXPECT_EQ(1u, value.count(key)) << key;
}

TEST_F(DriverTest, SecondDriverNamesTheUserOfTheRemote) {
  ASSERT_TRUE(spinUntil([&] { return remote_->server.connected(); }));
  ASSERT_EQ(0, std::system(("ROS_NAMESPACE=wiimote_8 rosrun wiimote_tracker_driver driver_node "
                            "__name:=driver _device:=virtual:" +
                            parameter("files") + "_1.sock > /dev/null 2>&1 &")
                               .c_str()));
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  const auto said = [&] { return driverStatus(diagnostics, "wiimote_8").message; };
  EXPECT_TRUE(spinUntil([&] { return said().find(parameter("holder")) != std::string::npos; }))
      << said();
  EXPECT_EQ(0, std::system("rosnode kill /wiimote_8/driver > /dev/null"));
}

TEST_F(DriverTest, UnplugAndReplugIsANewEpochOfTheSameStream) {
  remote_->sense(lights({{291, 69, 3, 9}}));
  Recorder<IrBlobArray> blobs("/wiimote_1/ir_blobs");
  ASSERT_TRUE(spinUntil([&] { return !blobs.messages.empty(); }));
  remote_->server.setPresent(false);

  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  EXPECT_TRUE(spinUntil([&] {  // this driver: others have no remote at all
    const auto status = driverStatus(diagnostics);
    return status.level == diagnostic_msgs::DiagnosticStatus::ERROR &&
           status.message.find("no virtual Wii Remote listens") != std::string::npos;
  })) << "diagnostics say what is missing";

  const std::uint32_t epoch = blobs.messages.back().clock_epoch;
  remote_->server.setPresent(true);
  ASSERT_TRUE(spinUntil(
      [&] { return blobs.last().clock_epoch > epoch && !blobs.messages.back().blobs.empty(); }));
  const auto first =
      std::find_if(blobs.messages.begin(), blobs.messages.end(),
                   [&](const IrBlobArray& message) { return message.clock_epoch > epoch; });
  ASSERT_TRUE(first != blobs.messages.begin());
  EXPECT_EQ(epoch + 1, first->clock_epoch);
  EXPECT_EQ(std::prev(first)->frame + 1, first->frame);
  EXPECT_EQ(698, blobs.messages.back().blobs[0].y);
}

TEST_F(DriverTest, ButtonsAreReleasedWhenTheRemoteHasGone) {
  Senses senses;
  senses.buttons = 0x0008;  // A
  remote_->sense(senses);
  Recorder<sensor_msgs::Joy> joy("/wiimote_1/joy");
  ASSERT_TRUE(spinUntil([&] { return joy.any() && joy.last().buttons.at(2) == 1; }));
  remote_->server.setPresent(false);
  EXPECT_TRUE(spinUntil([&] { return joy.last().buttons == std::vector<int>(11, 0); }));
  remote_->server.setPresent(true);
}

// The last test: the driver does not return.
TEST_F(DriverTest, ShutDownSwitchesTheRemoteOff) {
  ASSERT_TRUE(spinUntil([&] { return remote_->server.connected(); }));
  ASSERT_TRUE(spinUntil([&] { return remote_->server.leds() == 0x4; })) << "as configured";
  ASSERT_EQ(0, std::system("rosnode kill /wiimote_1/driver > /dev/null"));
  EXPECT_TRUE(spinUntil([&] { return !remote_->server.connected(); }));
  EXPECT_EQ(0x0, remote_->server.leds());
  EXPECT_FALSE(remote_->server.rumble());
}

}  // namespace
}  // namespace wiimote_tracker::driver
