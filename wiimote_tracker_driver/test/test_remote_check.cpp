// list_wiimotes with a virtual remote.
#include "contains.h"
#include "temporary_folder.h"
#include "tools/list_wiimotes/remote_check.h"
#include "waiting.h"
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace wiimote_tracker::list_wiimotes {
namespace {

class RemoteTest : public testing::Test {
 protected:
  RemoteTest() : server_(folder_ / "remote.sock", "00:1f:32:00:00:01", options()) {}
  static virtual_wiimote::Device::Options options() {
    virtual_wiimote::Device::Options options;
    options.battery = 0x50;
    return options;
  }
  transport::DeviceName device() const {
    return transport::parseDeviceName("virtual:" + folder_ / "remote.sock");
  }
  // The server handles reports in its own thread.
  bool showsLeds(std::uint8_t leds) const {
    return eventually([&] { return server_.leds() == leds; });
  }

  const TemporaryFolder folder_;
  virtual_wiimote::Server server_;
};

TEST_F(RemoteTest, AFreeOneReportsItsBattery) {
  const RemoteCheck check = checkRemote(device(), 10.0);
  ASSERT_EQ(RemoteCheck::State::kFree, check.state) << check.sentence;
  EXPECT_EQ("00:1f:32:00:00:01", check.identity);
  EXPECT_EQ(0x50, check.status->battery);
}

TEST_F(RemoteTest, AnOccupiedOneIsNotDisturbed) {
  const auto driver = transport::open(device());
  const RemoteCheck check = checkRemote(device(), 10.0);
  EXPECT_EQ(RemoteCheck::State::kTaken, check.state);
  EXPECT_TRUE(contains(check.sentence, "in use"));
  protocol::Report report;
  EXPECT_FALSE(driver->read(report, 0.0));
}

TEST_F(RemoteTest, AnAbsentOneIsAnError) {
  server_.setPresent(false);
  const RemoteCheck check = checkRemote(device(), 10.0);
  EXPECT_EQ(RemoteCheck::State::kFailed, check.state);
  EXPECT_NE("", check.sentence);
}

TEST_F(RemoteTest, FlashesByItsNumberAndThenRestoresItsLeds) {
  const auto remote = transport::open(device());
  std::vector<std::uint8_t> shown;
  std::uint8_t expected = 0x0;
  // The LEDs change from dark to lit or back after each wait; the pause at either end is dark.
  flash(*remote, 3, 0x4, [&](double seconds) {
    EXPECT_GT(seconds, 0.1);
    EXPECT_TRUE(showsLeds(expected)) << shown.size();
    shown.push_back(server_.leds());
    expected = shown.size() % 2 == 1 && shown.size() < 7 ? 0xf : 0x0;
  });
  EXPECT_EQ((std::vector<std::uint8_t>{0, 0xf, 0, 0xf, 0, 0xf, 0, 0}), shown);
  EXPECT_TRUE(showsLeds(0x4));
}

}  // namespace
}  // namespace wiimote_tracker::list_wiimotes
