// What other programs change in a remote, and what it loses, in fake time: found and restored.
#include "wiimote_fixture.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

TEST_F(WiimoteTest, OtherReportIdIsNoImageAndIsCorrected) {
  runToImage();
  const std::size_t before = remote_.written.size();
  remote_.mode = 0x30;
  remote_.say({0x31, 0, 0, 0x80, 0x80, 0x80});
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.05);
  ASSERT_LE(before + 2, remote_.written.size());
  EXPECT_EQ(kReport33, remote_.written[before].report);
  EXPECT_EQ(kVerify, remote_.written[before + 1].report);
  EXPECT_TRUE(streaming());
}

TEST_F(WiimoteTest, CameraReprogrammedByOthersIsSetUpAgain) {
  runToImage();
  remote_.registers[0x33] = 1;  // basic format, as the kernel's own driver does
  remote_.mode = 0x36;
  Report foreign{0x36, 0, 0};
  foreign.size = 22;
  remote_.say(foreign);
  const int clocks = remote_.count(kClock);
  run(0.2);
  EXPECT_EQ(clocks + 1, remote_.count(kClock));
  EXPECT_EQ(3, remote_.registers[0x33]);
  EXPECT_NEAR(50, run(0.5), 1);
  EXPECT_TRUE(last_.spots[0].seen);
}

TEST_F(WiimoteTest, CameraSwitchedOffByOthersIsNoticedInTheDark) {
  runToImage();
  remote_.camera = false;
  run(0.7);
  EXPECT_EQ(2, remote_.count(kClock));
  EXPECT_TRUE(remote_.camera);
  run(0.1);
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, DarknessAloneStopsNoImage) {
  remote_.light = false;
  runToImage();
  const int images = run(100.0);
  EXPECT_NEAR(10000, images, 50);
  EXPECT_EQ(1, remote_.count(kClock));
  EXPECT_EQ(0u, wiimote_.link().restorations);
  // In the handshake, after 0.5 s of darkness, and every 6 s.
  EXPECT_NEAR(1 + 1 + 100.0 / 6.0, remote_.count(kVerify), 1);
}

TEST_F(WiimoteTest, LightThatBlinksCausesNoChecks) {
  runToImage();
  for (int i = 0; i < 4; ++i) {
    remote_.light = !remote_.light;
    run(0.4);
  }
  EXPECT_EQ(1, remote_.count(kVerify));
}

TEST_F(WiimoteTest, LostModeIsSetAgainAfterTheShortestSilence) {
  runToImage();
  remote_.mode = 0x30;
  const double then = remote_.now;
  runToImage();
  EXPECT_NEAR(0.1, remote_.now - then, 0.025);
  EXPECT_EQ(1, remote_.count(kClock));
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, LostModeThatCannotBeSetAtOnceIsLeftToTheWatchdog) {
  runToImage();
  remote_.mode = 0x30;
  int losses = 1;
  remote_.lose = [&](const Report& report) { return report == kReport33 && losses-- > 0; };
  const double then = remote_.now;
  runToImage();
  EXPECT_NEAR(0.6, remote_.now - then, 0.05) << "0.5 s after the first attempt";
  run(0.1);
  EXPECT_EQ(1u, wiimote_.link().restorations);
  EXPECT_EQ("the images stopped", wiimote_.link().last_restoration);
  EXPECT_EQ(1, remote_.count(kClock));
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, PowerCycleBehindAnOpenConnectionStartsAllOver) {
  runToImage();
  remote_.powerCycle();
  const double then = remote_.now;
  run(0.8);
  EXPECT_LT(remote_.now - then, 1.0);
  EXPECT_TRUE(streaming());
  EXPECT_EQ(2, remote_.count(kLedOne));
  EXPECT_EQ(2, remote_.count(kRun));
  EXPECT_EQ(0x1, remote_.leds);
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(1, remote_.opened);
  EXPECT_EQ(1u, wiimote_.link().clock_epoch);
  EXPECT_EQ(1u, wiimote_.link().restorations);
  EXPECT_EQ("the remote was switched off and on", wiimote_.link().last_restoration);
}

// The remote sends nothing by itself in a mode that reports changes only.
TEST_F(WiimoteTest, FormatChangedInSilenceIsNoPowerCycle) {
  runToImage();
  remote_.registers[0x33] = 1;
  remote_.mode = 0x30;
  const double then = remote_.now;
  while (wiimote_.link().restorations < 1 && remote_.now < then + 2.0)
    run(0.01);
  EXPECT_LT(remote_.now - then, 0.2);
  EXPECT_EQ("the camera's format was changed", wiimote_.link().last_restoration);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  EXPECT_EQ(3, remote_.registers[0x33]);
}

TEST_F(WiimoteTest, CameraSwitchedOffInSilenceIsNoPowerCycle) {
  runToImage();
  remote_.camera = remote_.logic = false;
  remote_.mode = 0x30;
  run(0.4);
  EXPECT_EQ("the camera was switched off", wiimote_.link().last_restoration);
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, RadioSilenceIsNoPowerCycle) {
  runToImage();
  for (const double silence : {0.3, 0.8, 3.0, 4.4}) {
    remote_.answers = false;
    remote_.mode = 0x30;
    run(silence);
    remote_.answers = true;
    run(1.0);
    EXPECT_TRUE(streaming()) << silence;
    EXPECT_TRUE(last_.spots[0].seen);
    EXPECT_EQ("the images stopped", wiimote_.link().last_restoration) << silence;
  }
  EXPECT_EQ(1, remote_.opened);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, ImagesThatNoCameraInThisFormatSendsCauseACheck) {
  runToImage();
  run(1.1);
  const int checks = remote_.count(kVerify);
  Report foreign{0x33, 0, 0, 0x80, 0x80, 0x80, 0x23, 0x45, 0x1f, 0xff, 0xff, 0xc0};
  foreign.size = 18;
  remote_.say(foreign);
  run(0.02);
  EXPECT_EQ(checks + 1, remote_.count(kVerify));
  // A clone that always sends such data is not checked all the time.
  for (int i = 0; i < 1000; ++i) {
    remote_.say(foreign);
    run(0.01);
  }
  EXPECT_LE(remote_.count(kVerify), checks + 1 + 10 + 2);
  EXPECT_EQ(0u, wiimote_.link().restorations);
}

TEST_F(WiimoteTest, ChecksAreAsRareAsStated) {
  runToImage();
  run(60.0);
  int reads = 0;
  for (const FakeRemote::Written& written : remote_.written)
    reads += written.report.bytes[0] == 0x17 && written.time > 101.0;
  EXPECT_NEAR(30, reads, 1);
}

TEST_F(WiimoteTest, CheckWithoutAnswerDisturbsNoStream) {
  runToImage();
  remote_.lose = [](const Report& report) { return report.bytes[0] == 0x17; };
  EXPECT_NEAR(2000, run(20.0), 2);
  EXPECT_EQ(1, remote_.count(kClock));
  EXPECT_EQ(0u, wiimote_.link().restorations);
}

TEST_F(WiimoteTest, CheckDuringAForeignLongReadWaits) {
  runToImage();
  const double busy_until = remote_.now + 2.3;
  remote_.lose = [&](const Report& report) {
    const bool busy = report.bytes[0] == 0x17 && remote_.now < busy_until;
    if (busy)
      remote_.say({0x22, 0, 0, 0x17, 0x04}, 0.005);
    return busy;
  };
  EXPECT_NEAR(600, run(6.0), 2);
  EXPECT_EQ(1, remote_.count(kClock));
  EXPECT_EQ(0u, wiimote_.link().restorations);
}

struct Manipulation {
  const char* found;
  void (*act)(FakeRemote&);
  double within;  ///< [s] until it is put right.
};

class ManipulationTest : public WiimoteTest, public testing::WithParamInterface<Manipulation> {};

TEST_P(ManipulationTest, IsDetectedRestoredCountedAndNamed) {
  runToImage();
  run(0.73);
  const std::map<int, std::uint8_t> registers = remote_.registers;
  for (std::uint64_t times = 1; times <= 3; ++times) {
    GetParam().act(remote_);
    const double then = remote_.now;
    while (wiimote_.link().restorations < times && remote_.now < then + 20.0)
      run(0.01);
    EXPECT_EQ(times, wiimote_.link().restorations);
    EXPECT_LE(remote_.now - then, GetParam().within);
    EXPECT_EQ(GetParam().found, wiimote_.link().last_restoration);
    EXPECT_EQ(registers, remote_.registers);
    EXPECT_TRUE(remote_.camera);
    EXPECT_TRUE(remote_.logic);
    EXPECT_EQ(0x33, remote_.mode);
    EXPECT_NEAR(100, run(1.0), 2);
    EXPECT_TRUE(last_.spots[0].seen);
    EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  }
  run(30.0);
  EXPECT_EQ(3u, wiimote_.link().restorations);
}

constexpr char kSensitivityChanged[] = "the camera's sensitivity was changed";
// Each third of the configuration is checked every 6 s.
constexpr double kSilent = 6.2;
INSTANTIATE_TEST_SUITE_P(
    Others,
    ManipulationTest,
    testing::Values(
        Manipulation{"the camera was switched off", [](FakeRemote& r) { r.camera = false; }, 0.7},
        Manipulation{"the camera's logic was switched off", [](FakeRemote& r) { r.logic = false; },
                     0.7},
        Manipulation{"the camera was stopped", [](FakeRemote& r) { r.registers[0x30] = 1; }, 0.7},
        Manipulation{"the camera's format was changed",
                     [](FakeRemote& r) { r.registers[0x33] = 1; }, 0.7},
        Manipulation{"the camera's format was changed",
                     [](FakeRemote& r) { r.registers[0x33] = 5; }, 0.7},
        Manipulation{kSensitivityChanged, [](FakeRemote& r) { r.registers[0x1a] = 0; }, kSilent},
        Manipulation{kSensitivityChanged, [](FakeRemote& r) { r.registers[0x1b] = 5; }, kSilent},
        Manipulation{kSensitivityChanged, [](FakeRemote& r) { r.registers[0x00] = 2; }, kSilent},
        Manipulation{kSensitivityChanged, [](FakeRemote& r) { r.registers[0x08] = 0x41; }, kSilent},
        Manipulation{"the report mode was changed",
                     [](FakeRemote& r) {
                       r.mode = 0x31;
                       r.say({0x31, 0, 0, 0x80, 0x80, 0x80});
                     },
                     0.1}));

// ---- Remotes whose registers cannot be read

TEST_F(WiimoteTest, UnreadableRegistersDoNotPreventStreaming) {
  remote_.registers_readable = false;
  runToImage();
  EXPECT_EQ(3, remote_.count(kVerify));
  EXPECT_EQ(1, remote_.opened);
  EXPECT_NEAR(100, run(1.0), 1);
  // Silence then has no known cause, so everything is set up again.
  remote_.powerCycle();
  run(0.8);
  EXPECT_TRUE(streaming());
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(1u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, DarknessIsNoFailureOfARemoteWithUnreadableRegisters) {
  remote_.registers_readable = false;
  runToImage();
  for (int i = 0; i < 20; ++i) {
    remote_.light = false;
    run(1.0);
    remote_.light = true;
    run(1.0);
  }
  EXPECT_EQ(1, remote_.opened);
  EXPECT_TRUE(last_.spots[0].seen);
}

TEST_F(WiimoteTest, DarknessCostsFewImagesOfARemoteWithUnreadableRegisters) {
  remote_.registers_readable = false;
  runToImage();
  run(1.0);
  const std::uint64_t changes = wiimote_.linkChanges();
  remote_.light = false;
  EXPECT_GT(run(120.0), 11900);
  EXPECT_EQ(changes + 1, wiimote_.linkChanges()) << "only the battery's state";
  // The camera is still found when it was switched off in the dark.
  remote_.camera = remote_.logic = false;
  remote_.registers.clear();
  remote_.light = true;
  run(61.0);
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, LostModeOfARemoteWithUnreadableRegistersIsNoPowerCycle) {
  remote_.registers_readable = false;
  runToImage();
  remote_.mode = 0x30;
  const double then = remote_.now;
  runToImage();
  EXPECT_NEAR(0.1, remote_.now - then, 0.025);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, RegistersThatAreAlwaysBusyDoNotPreventStreaming) {
  remote_.lose = [&](const Report& report) {
    return report.bytes[0] == 0x17 && report.bytes[1] != 0;
  };
  int images = 0;
  for (int i = 0; i < 2000; ++i) {
    remote_.say({0x22, 0, 0, 0x17, 0x04});
    images += run(0.01);
  }
  EXPECT_GT(images, 900);
  EXPECT_EQ(1, remote_.opened);
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
