// Driver and virtual remote share no code, so each must read what the other writes.
#include "driven_device.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace wiimote_tracker::wiimote {
namespace {

using virtual_wiimote::Bytes;
using virtual_wiimote::Device;
using virtual_wiimote::Senses;

TEST(AgainstVirtualWiimote, EverySensitivityShowsTheLight) {
  for (const std::string& name : protocol::irSensitivityNames()) {
    Options options;
    options.sensitivity = *protocol::irSensitivity(name);
    options.leds = 0x5;
    Driven driven(options);
    driven.remote.senses.lights = {{123, 456, 7, 1}};
    ASSERT_TRUE(driven.runToLight()) << name;
    EXPECT_EQ(123, driven.last.spots[0].x);
    EXPECT_EQ(456, driven.last.spots[0].y);
    EXPECT_EQ(7, driven.last.spots[0].size);
    EXPECT_EQ(0x5, driven.remote.device.device().leds());
    const Link& link = driven.wiimote.link();
    EXPECT_TRUE(link.accelerometer_calibrated);
    EXPECT_EQ(0u, link.clock_epoch);
    ASSERT_TRUE(link.ir_calibration);
    EXPECT_EQ((std::array<int, 2>{907, 650}), link.ir_calibration->points[1]);
    const std::array<double, 3> g = driven.wiimote.accelerometer().toG(*driven.last.acceleration);
    EXPECT_NEAR(0.0, g[0], 0.02);
    EXPECT_NEAR(0.0, g[1], 0.02);
    EXPECT_NEAR(1.0, g[2], 0.02);
  }
}

Options withFormat(protocol::IrFormat format) {
  Options options;
  options.ir_format = format;
  return options;
}

TEST(AgainstVirtualWiimote, EveryFormatStreams) {
  for (const auto format :
       {protocol::IrFormat::kBasic, protocol::IrFormat::kExtended, protocol::IrFormat::kFull}) {
    Driven driven(withFormat(format));
    driven.remote.senses.lights = {{123, 456, 3, 1}, {900, 20, 5, 2}, {10, 700, 4, 3}};
    ASSERT_TRUE(driven.runToLight());
    const bool full = format == protocol::IrFormat::kFull;
    EXPECT_NEAR(full ? 500 : 1000, driven.run(10.0), 6);
    EXPECT_EQ(format, driven.last.ir_format);
    EXPECT_TRUE(driven.last.plausible);
    int seen = 0;
    for (const protocol::IrSpot& spot : driven.last.spots) {
      if (!spot.seen)
        continue;
      ++seen;
      EXPECT_EQ(format == protocol::IrFormat::kBasic, spot.size == 0);
      EXPECT_EQ(full, spot.intensity > 0);
      if (full) {
        EXPECT_LE(spot.box[0], spot.x / 8);
        EXPECT_LE(spot.box[1], spot.y / 8);
        EXPECT_GE(spot.box[2], spot.x / 8);
        EXPECT_GE(spot.box[3], spot.y / 8);
      }
    }
    EXPECT_EQ(3, seen);
    const std::array<double, 3> g = driven.wiimote.accelerometer().toG(*driven.last.acceleration);
    EXPECT_NEAR(1.0, g[2], full ? 0.05 : 0.02);
    EXPECT_EQ(0u, driven.wiimote.link().restorations);
  }
}

TEST(AgainstVirtualWiimote, ActiveMotionPlusBlocksNoFormat) {
  for (const auto format :
       {protocol::IrFormat::kBasic, protocol::IrFormat::kExtended, protocol::IrFormat::kFull}) {
    Device::Options device;
    device.motion_plus = true;
    Driven driven(withFormat(format), {}, device);
    driven.remote.senses.lights = {{123, 456, 3, 1}};
    ASSERT_TRUE(driven.runToLight());
    // Another program activates it: to the driver it is as if an extension were plugged in.
    driven.remote.said.emplace_back(driven.remote.now + 0.001,
                                    Bytes{0x16, 0x04, 0xa6, 0x00, 0xfe, 1, 0x04});
    driven.run(1.0);
    ASSERT_TRUE(driven.wiimote.link().status);
    EXPECT_TRUE(driven.wiimote.link().status->extension);
    EXPECT_NEAR(format == protocol::IrFormat::kFull ? 50 : 100, driven.run(1.0), 2);
    EXPECT_EQ(format, driven.last.ir_format);
  }
}

/// A light that level 1 of the console does not show.
virtual_wiimote::Light dim() {
  virtual_wiimote::Light light{500, 400, {}, 0.0};
  light.brightness = 0.03;
  return light;
}

TEST(AgainstVirtualWiimote, SensitivityChangedInTheStreamShowsAtOnce) {
  Options options;
  options.sensitivity = *protocol::irSensitivity("wii_1");
  Driven driven(options);
  driven.remote.senses.lights = {dim()};
  driven.run(1.0);
  EXPECT_EQ(0, driven.run(1.0));
  driven.missing = 0;
  driven.wiimote.setSensitivity(*protocol::irSensitivity("max"));
  const int lit = driven.run(1.0);
  // Five round trips of 12 ms, during which the camera is stopped.
  RecordProperty("missing_images", driven.missing);
  EXPECT_LE(driven.missing, 7);
  EXPECT_GE(lit, 90);
  EXPECT_NEAR(100, driven.run(1.0), 1);
  driven.wiimote.setSensitivity(*protocol::irSensitivity("wii_1"));
  EXPECT_LE(driven.run(1.0), 2);
  EXPECT_EQ(0u, driven.wiimote.link().clock_epoch);
  EXPECT_EQ(0u, driven.wiimote.link().restorations);
}

/// Missing images in 100 s.
int missing(double status_interval, bool kernel) {
  Options options;
  options.status_interval = status_interval;
  virtual_wiimote::Faults faults;
  faults.second_master = kernel;
  Driven driven(options, faults);
  driven.remote.senses.lights = {{123, 456, 7, 1}};
  EXPECT_TRUE(driven.runToLight());
  driven.run(3.0);
  driven.missing = 0;
  driven.run(100.0);
  return driven.missing;
}

TEST(AgainstVirtualWiimote, RequestsForTheBatteryCostNoImage) {
  EXPECT_LE(missing(1.0, false), missing(1e6, false));
}

TEST(AgainstVirtualWiimote, RequestsForTheBatteryBesideTheKernelsDriverCostFewImages) {
  const double each = 0.01 * (missing(1.0, true) - missing(1e6, true));
  RecordProperty("missing_per_question", std::to_string(each));
  EXPECT_LE(each, 5.0);
}

TEST(AgainstVirtualWiimote, ChecksOfTheCameraCostOneImageInTwoHundredAtMost) {
  EXPECT_LE(missing(1e6, false), 50);
}

TEST(AgainstVirtualWiimote, AnyLightsAreTransmitted) {
  Device device;
  const std::vector<Bytes> set_up{
      {0x13, 0x04},
      {0x1a, 0x04},
      {0x16, 0x04, 0xb0, 0x00, 0x00, 9, 2, 0, 0, 0x71, 1, 0, 0xaa, 0, 0x64},
      {0x16, 0x04, 0xb0, 0x00, 0x1a, 2, 0x63, 3},
      {0x16, 0x04, 0xb0, 0x00, 0x30, 1, 8}};
  for (const Bytes& report : set_up)
    device.handleOutput(report);
  std::mt19937 random(7);
  const auto uniform = [&](int limit) { return static_cast<int>(random() % limit); };
  struct Mode {
    std::uint8_t camera;
    std::uint8_t report;
  };
  for (const Mode mode : {Mode{3, 0x33}, Mode{1, 0x36}, Mode{1, 0x37}}) {
    device.handleOutput({0x16, 0x04, 0xb0, 0x00, 0x33, 1, mode.camera});
    device.handleOutput({0x12, 0x04, mode.report});
    for (int i = 0; i < 2000; ++i) {
      Senses senses;
      senses.buttons = static_cast<std::uint16_t>(random() & 0x1f9f);
      const int count = uniform(5);
      // One light near each corner of the image, too far apart to merge.
      for (int light = 0; light < count; ++light) {
        const int x = uniform(392) + light % 2 * 632;
        const int y = uniform(263) + light / 2 * 504 + 1;
        const int size = 1 + uniform(15);
        senses.lights.push_back({1.0 * x, 1.0 * y, 1.0 * size, 1.0});
      }
      const auto sampled = device.sample(senses);
      ASSERT_TRUE(sampled);
      const auto data = protocol::decodeDataReport({sampled->data(), sampled->size()});
      ASSERT_TRUE(data);
      EXPECT_EQ(senses.buttons, data->buttons);
      // Slots are up to the device: the same lights in any order.
      using Spot = std::array<int, 3>;
      std::vector<Spot> expected;
      for (const auto& light : senses.lights)
        expected.push_back({static_cast<int>(light.x), static_cast<int>(light.y),
                            mode.camera == 3 ? static_cast<int>(*light.size) : 0});
      std::vector<Spot> decoded;
      for (const auto& spot : data->spots) {
        if (spot.seen)
          decoded.push_back({spot.x, spot.y, spot.size});
      }
      std::sort(expected.begin(), expected.end());
      std::sort(decoded.begin(), decoded.end());
      ASSERT_EQ(expected, decoded) << "report " << int{mode.report} << ", image " << i;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
