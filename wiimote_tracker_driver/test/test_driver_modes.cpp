// Drivers in the other modes, and one that plays the recording of test_driver.cpp.
#include "driver_helpers.h"

#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace wiimote_tracker::driver {
namespace {

using wiimote_tracker_msgs::IrBlobArray;

TEST(DriverInOtherModes, FullModeHasIntensityAndBoundingBox) {
  Remote full(parameter("files") + "_2.sock", "00:1f:32:00:00:08");
  full.sense(lights({{300, 100, 4, 9}, {1023, 0, 2, 3}}));
  Recorder<IrBlobArray> blobs("/wiimote_2/ir_blobs");
  ASSERT_TRUE(spinUntil([&] { return blobs.any() && blobs.last().blobs.size() == 2; }));
  const IrBlobArray& message = blobs.last();
  EXPECT_EQ(+IrBlobArray::IR_MODE_FULL, message.ir_mode);
  EXPECT_EQ(300, message.blobs[0].x);
  EXPECT_EQ(667, message.blobs[0].y);
  EXPECT_EQ(4, message.blobs[0].size);
  EXPECT_GT(message.blobs[0].intensity, message.blobs[1].intensity);
  EXPECT_GT(message.blobs[1].intensity, 0.0f);
  for (const auto& blob : message.blobs) {
    ASSERT_EQ(4u, blob.bounding_box.size());
    EXPECT_LE(blob.bounding_box[0], blob.x);
    EXPECT_LE(blob.bounding_box[1], blob.y);
    EXPECT_GE(blob.bounding_box[2], blob.x);
    EXPECT_GE(blob.bounding_box[3], blob.y);
    EXPECT_LT(blob.bounding_box[2] - blob.bounding_box[0], 64);
    EXPECT_LT(blob.bounding_box[3] - blob.bounding_box[1], 64);
  }
  EXPECT_TRUE(spinUntil([&] { return full.server.leds() == 0x2; })) << "the camera's number";

  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  ASSERT_TRUE(spinUntil([&] {  // after a stall of this computer it takes a while
    auto value = values(driverStatus(diagnostics, "wiimote_2"));
    return std::atof(value["rate [Hz]"].c_str()) > 1.0 &&
           std::abs(std::atof(value["period [ms]"].c_str()) - 20.07) < 0.2;
  }));
  auto value = values(driverStatus(diagnostics, "wiimote_2"));
  EXPECT_EQ("full", value["IR mode"]);
  EXPECT_NEAR(20.07, std::atof(value["period [ms]"].c_str()), 0.2);
}

TEST(DriverInOtherModes, BasicModeHasPositionsOnlyAndArrivalsCanBeStamps) {
  Remote basic(parameter("files") + "_3.sock", "00:1f:32:00:00:09");
  basic.sense(lights({{300, 100, 4, 9}}));
  Recorder<IrBlobArray> blobs("/wiimote_3/ir_blobs");
  ASSERT_TRUE(spinUntil([&] { return blobs.any() && blobs.last().blobs.size() == 1; }));
  const IrBlobArray& message = blobs.last();
  EXPECT_EQ(+IrBlobArray::IR_MODE_BASIC, message.ir_mode);
  EXPECT_EQ(300, message.blobs[0].x);
  EXPECT_EQ(667, message.blobs[0].y);
  EXPECT_TRUE(std::isnan(message.blobs[0].size));
  EXPECT_TRUE(std::isnan(message.blobs[0].intensity));
  EXPECT_TRUE(message.blobs[0].bounding_box.empty());
  // estimate_exposure is false and latency 20 ms in the launch file.
  EXPECT_TRUE(std::isnan(message.stamp_stddev));
  EXPECT_NEAR(0.02, (message.arrival - message.header.stamp).toSec(), 2e-6);
}

TEST(DriverInOtherModes, ARecordingIsPlayedAtItsOwnTimes) {
  const ros::Time now = ros::Time::now();
  Recorder<IrBlobArray> blobs("/wiimote_4/ir_blobs");
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  ASSERT_EQ(0, std::system(("ROS_NAMESPACE=wiimote_4 rosrun wiimote_tracker_driver driver_node "
                            "__name:=driver _replay_rate:=5 _device:=replay:" +
                            parameter("files") + "_1.wiirec > /dev/null 2>&1 &")
                               .c_str()));
  EXPECT_TRUE(spinUntil([&] { return blobs.messages.size() >= 100; }));
  for (const IrBlobArray& message : blobs.messages) {
    EXPECT_LT(message.arrival, now);
    EXPECT_GT(message.arrival, now - ros::Duration(600.0));
    EXPECT_EQ(kIdentity, message.identity);
    EXPECT_EQ("wiimote_4", message.camera);
  }
  EXPECT_TRUE(spinUntil([&] {
    return driverStatus(diagnostics, "wiimote_4").message.find("has ended") != std::string::npos;
  }));
  EXPECT_EQ(0, std::system("rosnode kill /wiimote_4/driver > /dev/null"));
  for (const char* left : {"_1.wiirec", "_1.yaml"})
    EXPECT_EQ(0, std::remove((parameter("files") + left).c_str())) << left;
}

}  // namespace
}  // namespace wiimote_tracker::driver
