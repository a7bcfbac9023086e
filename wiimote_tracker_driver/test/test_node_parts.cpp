// Messages and parameters of the node, without a master.
#include "ros/battery_publisher.h"
#include "ros/blob_publisher.h"
#include "ros/driver_parameters.h"
#include "ros/joy.h"
#include "ros/link_diagnostics.h"
#include "ros/link_log.h"

#include <documented_parameters.h>
#include <gtest/gtest.h>
#include <wiimote_tracker_driver/DriverConfig.h>
#include <wiimote_tracker_msgs/log_exceptions.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace wiimote_tracker::driver {
namespace {

protocol::IrSpot spot() {
  protocol::IrSpot s;
  s.seen = true;
  s.x = 300;
  s.y = 100;
  s.size = 4;
  s.intensity = 200;
  s.box = {36, 11, 38, 14};
  return s;
}

TEST(Blob, FullFormatHasAllFieldsWithYDown) {
  const auto blob = irBlob(spot(), protocol::IrFormat::kFull, 2);
  EXPECT_EQ(300, blob.x);
  EXPECT_EQ(667, blob.y);
  EXPECT_EQ(4, blob.size);
  EXPECT_EQ(200, blob.intensity);
  EXPECT_EQ(2, blob.slot);
  // Columns 36..38 are pixels 288..311. Rows 11..14 are 88..119 from below, so 648..679 from above.
  EXPECT_EQ((std::vector<float>{288, 648, 311, 679}), blob.bounding_box);
}

TEST(Blob, BoxOfTheWholeSensorIsTheImage) {
  protocol::IrSpot s = spot();
  s.box = {0, 0, 127, 95};
  EXPECT_EQ((std::vector<float>{0, 0, 1023, 767}),
            irBlob(s, protocol::IrFormat::kFull, 0).bounding_box);
}

TEST(Blob, OtherFormatsLeaveMissingFieldsUnknown) {
  const auto extended = irBlob(spot(), protocol::IrFormat::kExtended, 0);
  EXPECT_EQ(4, extended.size);
  EXPECT_TRUE(std::isnan(extended.intensity));
  EXPECT_TRUE(extended.bounding_box.empty());
  const auto basic = irBlob(spot(), protocol::IrFormat::kBasic, 0);
  EXPECT_TRUE(std::isnan(basic.size));
  EXPECT_TRUE(std::isnan(basic.intensity));
  EXPECT_TRUE(basic.bounding_box.empty());
}

TEST(Joy, EachButtonHasItsPlace) {
  const std::map<std::uint16_t, std::size_t> places{
      {0x0002, 0}, {0x0001, 1}, {0x0008, 2}, {0x0004, 3}, {0x1000, 4}, {0x0010, 5},
      {0x0100, 6}, {0x0200, 7}, {0x0800, 8}, {0x0400, 9}, {0x0080, 10}};
  for (const auto& place : places) {
    std::vector<int> expected(11, 0);
    expected[place.second] = 1;
    EXPECT_EQ(expected, joyButtons(place.first)) << std::hex << place.first;
  }
  EXPECT_EQ(std::vector<int>(11, 0), joyButtons(0));
}

TEST(PlayerLeds, AddUpToTheNumberInTheName) {
  for (int number = 1; number <= 10; ++number) {
    const std::uint8_t lit = leds(-1, "wiimote_" + std::to_string(number));
    int sum = 0;
    for (int led = 1; led <= 4; ++led)
      sum += (lit >> (led - 1) & 1) * led;
    EXPECT_EQ(number, sum);
    EXPECT_EQ(lit, leds(-1, "a" + std::to_string(number + 10)));
  }
  EXPECT_EQ(0x4, leds(-1, "wiimote_3"));
  EXPECT_EQ(0x1, leds(-1, "left"));
  EXPECT_EQ(0x1, leds(-1, ""));
  EXPECT_EQ(0xf, leds(-1, "wiimote_0"));
  EXPECT_EQ(0x6, leds(6, "wiimote_3"));
}

TEST(Battery, IsLowByItsChargeOrByItsFlag) {
  protocol::Status status;
  status.battery = 0x20;  // 29.6 %
  EXPECT_FALSE(batteryLow(status, 0.2));
  EXPECT_TRUE(batteryLow(status, 0.3));
  status.battery_low = true;
  EXPECT_TRUE(batteryLow(status, 0.0));
  EXPECT_EQ("30 %", batteryText(status, 0.3));
  status.battery = 160;
  EXPECT_EQ("the remote says so, at the raw level 160", batteryText(status, 0.3));
}

TEST(Sensitivity, ByNameOrCustom) {
  EXPECT_EQ(*protocol::irSensitivity("max"), sensitivity("max", "", ""));
  EXPECT_EQ(*protocol::irSensitivity("wii_5"),
            sensitivity("custom", "07 00 00 71 01 00 72 00 20", "1f 03"));
  EXPECT_THROW(sensitivity("custom", "", ""), std::invalid_argument);
  EXPECT_THROW(sensitivity("custom", "07 00", "1f 03"), std::invalid_argument);
  EXPECT_THROW(sensitivity("07 00 00 71 01 00 72 00 20 1f 03", "", ""), std::invalid_argument);
}

TEST(Parameters, TheFileDocumentsThem) {
  XmlRpc::XmlRpcValue nothing;
  nothing.begin();  // a struct without members
  ParameterReader reader(ParameterTree("parameters", nothing));
  readDriverParameters(&reader, "/wiimote_1");
  expectDocumented(reader, CONFIG_FOLDER "/driver.yaml");
}

TEST(Parameters, TheLiveSettingsHaveTheSameDefaults) {
  const DriverParameters p;
  const auto live = wiimote_tracker_driver::DriverConfig::__getDefault__();
  EXPECT_EQ(p.ir_sensitivity, live.ir_sensitivity);
  EXPECT_EQ(p.ir_sensitivity_block1, live.ir_sensitivity_block1);
  EXPECT_EQ(p.ir_sensitivity_block2, live.ir_sensitivity_block2);
  EXPECT_EQ(p.leds, live.leds);
  EXPECT_EQ(-1, wiimote_tracker_driver::DriverConfig::__getMin__().leds);
  EXPECT_EQ(15, wiimote_tracker_driver::DriverConfig::__getMax__().leds);
}

TEST(Parameters, TheLiveSettingsOfferEverySensitivity) {
  std::string menu;
  for (const auto& parameter : wiimote_tracker_driver::DriverConfig::__getParamDescriptions__()) {
    if (parameter->name == "ir_sensitivity")
      menu = parameter->edit_method;
  }
  for (const std::string& name : sensitivityNames())
    EXPECT_NE(std::string::npos, menu.find("'" + name + "'")) << name << " in " << menu;
}

TEST(LogExceptions, NoExceptionLeaves) {
  EXPECT_NO_THROW(logExceptions("wiimote_1", [] { throw std::runtime_error("reason"); }));
  EXPECT_NO_THROW(logExceptions("wiimote_1", [] { throw 1; }));
}

/// Everything that the action prints, also as a log.
template <typename Action>
std::string printed(Action action) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  action();
  const std::string out = testing::internal::GetCapturedStdout();
  return out + testing::internal::GetCapturedStderr();
}

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

// As with another program that changes the remote every 3 s.
TEST(Log, WhatIsPutRightAgainAndAgainIsNamedNowAndThen) {
  LinkLog log("wiimote_1", true);
  wiimote::Link link;
  link.accelerometer_calibrated = true;
  const std::string text = printed([&] {
    for (double now = 0.0; now < 700.0; now += 3.0) {
      link.state = wiimote::Link::State::kStarting;
      log.report(link, now);
      if (now > 0.0) {
        ++link.restorations;
        link.last_restoration = "the report mode was changed";
      }
      link.state = wiimote::Link::State::kStreaming;
      log.report(link, now + 0.1);
    }
  });
  EXPECT_EQ(1, count(text, "images come from")) << text;
  EXPECT_EQ(3, count(text, "put right: the report mode was changed")) << text;
  EXPECT_EQ(2, count(text, "another program")) << text;
}

// As on a busy computer.
TEST(Log, WhatIsPutRightOnceIsNoWarning) {
  LinkLog log("wiimote_1", true);
  wiimote::Link link;
  link.accelerometer_calibrated = true;
  link.state = wiimote::Link::State::kStreaming;
  link.restorations = 1;
  link.last_restoration = "the images stopped";
  const std::string text = printed([&] { log.report(link, 0.0); });
  EXPECT_EQ(1, count(text, "put right: the images stopped")) << text;
  EXPECT_EQ(0, count(text, "WARN")) << text;
}

TEST(Log, EachNewStreamIsAnnounced) {
  LinkLog log("wiimote_1", true);
  wiimote::Link link;
  const std::string text = printed([&] {
    link.state = wiimote::Link::State::kStreaming;
    log.report(link, 0.0);
    link.state = wiimote::Link::State::kSearching;
    link.error = "it was switched off";
    log.report(link, 1.0);
    link.state = wiimote::Link::State::kStarting;
    log.report(link, 2.0);
    link.state = wiimote::Link::State::kStreaming;
    link.error.clear();
    log.report(link, 3.0);
    ++link.clock_epoch;  // a power cycle behind an open connection
    log.report(link, 4.0);
  });
  EXPECT_EQ(3, count(text, "images come from")) << text;
  EXPECT_EQ(1, count(text, "it was switched off (trying again)")) << text;
  EXPECT_EQ(0, count(text, "put right")) << text;
}

// A loose battery, all day.
TEST(Log, ARemoteThatReconnectsAllDayFillsNoDisk) {
  LinkLog log("wiimote_1", true);
  wiimote::Link link;
  link.accelerometer_calibrated = true;
  const auto lose = [&](double now) {
    link.state = wiimote::Link::State::kSearching;
    link.error = "it has gone away";
    log.report(link, now);
  };
  const auto find = [&](double now) {
    link.state = wiimote::Link::State::kStreaming;
    link.error.clear();
    ++link.clock_epoch;
    log.report(link, now);
  };
  constexpr double kDay = 86400.0;  // [s]
  const std::string text = printed([&] {
    for (double now = 0.0; now < kDay; now += 2.0) {
      lose(now);
      find(now + 1.0);
    }
  });
  EXPECT_LE(100, count(text, "it has gone away")) << text;
  EXPECT_GE(155, count(text, "it has gone away")) << text;
  EXPECT_EQ(count(text, "it has gone away"), count(text, "images come from")) << text;
  const std::string later = printed([&] {
    lose(kDay + 3600.0);
    find(kDay + 3601.0);
  });
  EXPECT_EQ(1, count(later, "it has gone away (trying again)")) << later;
  EXPECT_EQ(1, count(later, "images come from")) << later;
}

TEST(Log, ARemoteThatIsOffAtNightIsNamedNowAndThen) {
  LinkLog log("wiimote_1", true);
  wiimote::Link link;
  link.error = "it is not there";
  const std::string text = printed([&] {
    for (double now = 0.0; now < 12.0 * 3600.0; now += 0.5)
      log.report(link, now);
  });
  EXPECT_LE(60, count(text, "it is not there")) << text;
  EXPECT_GE(82, count(text, "it is not there")) << text;
  EXPECT_LE(1, count(text, "one message in 10 minutes from now on")) << text;
}

class DiagnosticsTest : public testing::Test {
 protected:
  DiagnosticsTest() {
    state_.link.state = wiimote::Link::State::kStreaming;
    state_.link.accelerometer_calibrated = true;
    state_.stream.rate = 99.0;
    state_.clock.period = 0.01;
    state_.stamp_stddev = 0.0002;
  }

  diagnostic_updater::DiagnosticStatusWrapper describe() {
    diagnostic_updater::DiagnosticStatusWrapper status;
    diagnostics_.describe(state_, status);
    return status;
  }

  std::string value(const std::string& key) {
    for (const auto& value : describe().values) {
      if (value.key == key)
        return value.value;
    }
    return "";
  }

  DriverState state_;
  LinkDiagnostics diagnostics_{protocol::IrFormat::kExtended, 100.0, 0.2};
};

TEST_F(DiagnosticsTest, AllIsWell) {
  const auto status = describe();
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, status.level);
  EXPECT_EQ("streaming", status.message);
}

TEST_F(DiagnosticsTest, RestorationsAreReportedOnce) {
  state_.link.restorations = 2;
  state_.link.last_restoration = "the camera was switched off";
  const auto status = describe();
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::WARN, status.level);
  EXPECT_NE(std::string::npos, status.message.find("the camera was switched off"));
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, describe().level);
  EXPECT_EQ("2", value("restorations"));
  EXPECT_EQ("the camera was switched off", value("last restoration"));
}

TEST_F(DiagnosticsTest, WhatIsPutRightOnceIsNoWarning) {
  state_.link.restorations = 1;
  state_.link.last_restoration = "the images stopped";
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, describe().level);
  EXPECT_EQ("the images stopped", value("last restoration"));
  ++state_.link.restorations;
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::WARN, describe().level);
}

TEST_F(DiagnosticsTest, TheKernelsDriverIsNoWarningUnlessItMayHaveDoneHarm) {
  state_.link.remote.kernel_driver = "wiimote";
  const auto level = [&] {
    const auto status = describe();
    EXPECT_NE(std::string::npos, status.message.find("hid-wiimote")) << status.message;
    return status.level;
  };
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, level());
  state_.stream.gaps = 1;
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::WARN, level());
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, level());
  state_.link.restorations = 1;
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::WARN, level());
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, level());
  state_.stream.rate = 70.0;
  EXPECT_EQ(std::string::npos, describe().message.find("hid-wiimote")) << "another warning";
}

TEST_F(DiagnosticsTest, NoImageIsMissedRightAfterTheStreamBegan) {
  state_.stream.rate = 0.0;
  state_.stream.has_rate = false;
  EXPECT_EQ("streaming", describe().message);
}

TEST_F(DiagnosticsTest, ARemoteThatDropsOutOftenIsNotOnlyStreaming) {
  state_.stream.returns = 1;
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::OK, describe().level);
  state_.stream.returns = 3;
  const auto status = describe();
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::WARN, status.level);
  EXPECT_EQ(status.message,
            "the images stopped 3 times in ten minutes: bring the remote nearer to its "
            "Bluetooth adapter, or change its batteries");
}

TEST_F(DiagnosticsTest, ProblemsAreInTheSummary) {
  const auto says = [&](const std::string& text) {
    const auto status = describe();
    return status.level != diagnostic_msgs::DiagnosticStatus::OK &&
           status.message.find(text) != std::string::npos;
  };
  state_.stream.rate = 70.0;
  EXPECT_TRUE(says("only 70 images"));
  EXPECT_TRUE(says("bring the remote nearer"));
  state_.replayed = true;
  EXPECT_FALSE(says("bring the remote nearer")) << "a recording may be played slowly";
  state_.link.remote.kernel_driver = "wiimote";
  state_.stream.gaps = 1;
  EXPECT_TRUE(says("hid-wiimote"));
  state_.link.accelerometer_calibrated = false;
  EXPECT_TRUE(says("accelerometer calibration of the remote is damaged"));
  state_.link.accelerometer_unknown = true;
  EXPECT_TRUE(says("accelerometer calibration of the remote is unknown"));
  state_.shared_with = "somebody else reads along";
  EXPECT_TRUE(says("somebody else"));
  state_.recording_error = "the disk is full";
  EXPECT_TRUE(says("the disk is full"));
  state_.link.state = wiimote::Link::State::kStarting;
  EXPECT_TRUE(says("setting up the remote"));
  state_.link.state = wiimote::Link::State::kSearching;
  EXPECT_TRUE(says("looking for the remote"));
  state_.link.error = "no Wii Remote is connected";
  EXPECT_TRUE(says("no Wii Remote is connected"));
  EXPECT_EQ(diagnostic_msgs::DiagnosticStatus::ERROR, describe().level);
}

TEST_F(DiagnosticsTest, StateOfTheExposureClock) {
  EXPECT_EQ("in step", value("exposure clock"));
  state_.stamp_stddev = 0.01;
  EXPECT_EQ("learning", value("exposure clock"));
  state_.stamp_stddev = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ("off: stamps are arrivals less the latency", value("exposure clock"));
  state_.link.state = wiimote::Link::State::kSearching;
  EXPECT_EQ("no images", value("exposure clock"));
}

}  // namespace
}  // namespace wiimote_tracker::driver
