// What a user changes while a remote streams, in fake time: sensitivity, LEDs, motor.
#include "wiimote_fixture.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

const protocol::IrSensitivity kWii2 = *protocol::irSensitivity("wii_2");

TEST_F(WiimoteTest, SensitivityChangesInTheStream) {
  runToImage();
  const int modes = remote_.count(kReport33);
  std::vector<Link::State> states;
  wiimote_.setSensitivity(kWii2);
  const double then = remote_.now;
  int images = 0;
  for (int i = 0; i < 100; ++i) {
    images += run(0.01);
    states.push_back(wiimote_.link().state);
  }
  EXPECT_EQ(std::vector<Link::State>(100, Link::State::kStreaming), states);
  // Five writes of 5 ms each, while the camera is stopped.
  EXPECT_GE(images, 96);
  EXPECT_EQ(0x96, remote_.registers[0x06]);
  EXPECT_EQ(0xb3, remote_.registers[0x1a]);
  EXPECT_EQ(8, remote_.registers[0x30]);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  EXPECT_EQ(0u, wiimote_.link().restorations);
  EXPECT_EQ(1, remote_.count(kClock));
  EXPECT_EQ(modes + 1, remote_.count(kReport33));
  const Report first = std::find_if(remote_.written.begin(), remote_.written.end(),
                                    [&](const FakeRemote::Written& w) { return w.time >= then; })
                           ->report;
  EXPECT_EQ(kSetup, first) << "the camera is stopped first";
  // The same once more changes nothing.
  const std::size_t written = remote_.written.size();
  wiimote_.setSensitivity(kWii2);
  EXPECT_EQ(written, remote_.written.size());
}

TEST_F(WiimoteTest, NoImageIsTakenWhileTheCameraIsStopped) {
  runToImage();
  wiimote_.setSensitivity(kWii2);
  int images = 0;
  for (int i = 0; i < 50; ++i) {
    if (const int taken = run(0.01); taken > 0) {
      EXPECT_TRUE(last_.spots[0].seen) << "image " << i;
      images += taken;
    }
  }
  EXPECT_GE(images, 46) << "it runs again";
}

TEST_F(WiimoteTest, TheLastSensitivityAppliesAtAnyMomentOfChange) {
  const protocol::IrSensitivity marcan = *protocol::irSensitivity("marcan");
  for (int i = 0; i < 240; ++i) {
    const int milliseconds = i / 2;
    const double moment = 100.0 + 0.001 * milliseconds;
    FakeRemote remote;
    Wiimote wiimote(
        Options(), [&](bool) { return remote.open(); }, [&] { return remote.now; });
    const auto runUntil = [&](double end) {
      int images = 0;
      while (remote.now < end)
        images += wiimote.step(end - remote.now).has_value();
      return images;
    };
    runUntil(moment);
    if (i % 2 == 1) {  // twice, the second time before the first is done
      wiimote.setSensitivity(kWii2);
      runUntil(moment + 0.0075);
    }
    wiimote.setSensitivity(marcan);
    EXPECT_GT(runUntil(101.0), 60) << i;
    EXPECT_EQ(0x90, remote.registers[0x06]) << i;
    EXPECT_EQ(0xc0, remote.registers[0x08]) << i;
    EXPECT_EQ(0x40, remote.registers[0x1a]) << i;
    EXPECT_EQ(8, remote.registers[0x30]) << i;
    EXPECT_EQ(0u, wiimote.link().clock_epoch);
    EXPECT_EQ(0u, wiimote.link().restorations) << i;
  }
}

TEST_F(WiimoteTest, LedsChangeAtOnce) {
  runToImage();
  wiimote_.setLeds(0xa);
  EXPECT_NEAR(100, run(1.0), 1);
  EXPECT_EQ(0xa, remote_.leds);
}

TEST_F(WiimoteTest, MotorRunsUntilStoppedWhateverOthersWrite) {
  runToImage();
  for (const FakeRemote::Written& written : remote_.written)
    EXPECT_EQ(0, written.report.bytes[1] & 1) << "never by ourselves";
  wiimote_.setRumble(true);
  EXPECT_TRUE(remote_.rumble);
  const std::size_t before = remote_.written.size();
  for (int i = 0; i < 40; ++i) {
    remote_.rumble = false;  // the kernel has written something
    EXPECT_NEAR(11, run(0.11), 2);
    EXPECT_TRUE(remote_.rumble);
  }
  wiimote_.setSensitivity(kWii2);
  wiimote_.setLeds(0x3);
  run(1.0);
  EXPECT_EQ(0x96, remote_.registers[0x06]);
  EXPECT_EQ(0x3, remote_.leds);
  for (std::size_t i = before; i < remote_.written.size(); ++i)
    EXPECT_EQ(1, remote_.written[i].report.bytes[1] & 1) << "report " << i;
  wiimote_.setRumble(false);
  run(5.0);
  EXPECT_FALSE(remote_.rumble);
}

TEST_F(WiimoteTest, MotorIsOffAfterCloseAndAfterAReconnect) {
  runToImage();
  wiimote_.setRumble(true);
  remote_.present = false;
  run(1.0);
  remote_.powerCycle();
  remote_.present = true;
  runToImage();
  run(1.0);
  EXPECT_FALSE(remote_.rumble);
  wiimote_.setRumble(true);
  EXPECT_TRUE(remote_.rumble);
  wiimote_.close();
  EXPECT_FALSE(remote_.rumble);
}

TEST_F(WiimoteTest, SensitivityAndLedsAreKeptOverAReconnect) {
  wiimote_.setLeds(0xc);  // before there is a remote
  runToImage();
  EXPECT_EQ(0xc, remote_.leds);
  wiimote_.setSensitivity(kWii2);
  wiimote_.setLeds(0x6);
  run(0.5);
  remote_.present = false;
  run(1.0);
  remote_.powerCycle();
  remote_.present = true;
  runToImage();
  EXPECT_EQ(0x6, remote_.leds);
  EXPECT_EQ(0x96, remote_.registers[0x06]);
}

TEST_F(WiimoteTest, SettingSomethingWhenTheRemoteHasJustGoneIsHarmless) {
  runToImage();
  remote_.present = false;
  EXPECT_NO_THROW(wiimote_.setSensitivity(kWii2));
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_NO_THROW(wiimote_.setLeds(0x2));
  EXPECT_NO_THROW(wiimote_.setRumble(true));
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
