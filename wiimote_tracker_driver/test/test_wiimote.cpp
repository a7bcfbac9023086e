// The driver's state machine for a remote, in fake time: it starts the images and keeps them
// coming, from a remote that loses, refuses, forgets and disappears.
#include "fake_remote.h"
#include "wiimote/wiimote.h"

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <random>
#include <stdexcept>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::DataReport;
using protocol::Report;

/// A register write as it crosses the wire.
Report write(std::uint8_t address, std::vector<std::uint8_t> data) {
  Report report{0x16, 0x04, 0xb0, 0x00, address, static_cast<std::uint8_t>(data.size())};
  std::copy(data.begin(), data.end(), report.bytes.begin() + 6);
  report.size = 22;
  return report;
}

const Report kStatusRequest{0x15, 0x00};
const Report kLedOne{0x11, 0x12};
const Report kReadIrBlock{0x17, 0x00, 0x00, 0x00, 0x00, 0x00, 0x0b};
const Report kReadIrCopy{0x17, 0x00, 0x00, 0x00, 0x0b, 0x00, 0x0b};
const Report kReadBlock{0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x0a};
const Report kReadCopy{0x17, 0x00, 0x00, 0x00, 0x20, 0x00, 0x0a};
const Report kClock{0x13, 0x06};
const Report kLogic{0x1a, 0x06};
const Report kSetup = write(0x30, {0x01});
const Report kBlock1 = write(0x00, {0x07, 0, 0, 0x71, 0x01, 0, 0x72, 0, 0x20});
const Report kBlock2 = write(0x1a, {0x1f, 0x03});
const Report kMode = write(0x33, {0x03});
const Report kRun = write(0x30, {0x08});
const Report kVerify{0x17, 0x04, 0xb0, 0x00, 0x30, 0x00, 0x04};
const Report kVerifyBlock1{0x17, 0x04, 0xb0, 0x00, 0x00, 0x00, 0x09};
const Report kVerifyBlock2{0x17, 0x04, 0xb0, 0x00, 0x1a, 0x00, 0x02};
const Report kReport33{0x12, 0x06, 0x33};

const std::vector<Report> kHandshake{kStatusRequest, kLedOne,       kReadIrBlock, kReadBlock,
                                     kClock,         kLogic,        kSetup,       kBlock1,
                                     kBlock2,        kMode,         kRun,         kVerify,
                                     kVerifyBlock1,  kVerifyBlock2, kReport33};

class WiimoteTest : public testing::Test {
 protected:
  explicit WiimoteTest(const Options& options = Options())
      : wiimote_(
            options,
            [this] { return remote_.open(); },
            [this] { return remote_.now; }) {}

  /// Advances the time. @returns the number of images.
  int run(double duration) {
    const double end = remote_.now + duration;
    int images = 0;
    while (remote_.now < end) {
      if (const double idle = wiimote_.idleTime())
        remote_.now = std::min(end, remote_.now + idle);
      if (const auto image = wiimote_.step(std::max(0.0, std::min(0.1, end - remote_.now)))) {
        ++images;
        last_ = *image;
      }
    }
    return images;
  }

  /// Runs until an image has come; fails when none does within a minute.
  void runToImage() {
    const double end = remote_.now + 60.0;
    while (remote_.now < end) {
      if (run(0.01) > 0)
        return;
    }
    FAIL() << "no image";
  }

  bool streaming() const { return wiimote_.link().state == Link::State::kStreaming; }

  FakeRemote remote_;
  Wiimote wiimote_;
  DataReport last_;
};

TEST_F(WiimoteTest, HandshakeInOrderEachStepAfterTheAnswerToTheLast) {
  runToImage();
  ASSERT_EQ(kHandshake.size(), remote_.written.size());
  for (std::size_t i = 0; i < kHandshake.size(); ++i) {
    EXPECT_EQ(kHandshake[i], remote_.written[i].report) << "step " << i;
    EXPECT_NEAR(100.0 + 0.005 * static_cast<double>(i), remote_.written[i].time, 1e-9);
  }
  EXPECT_TRUE(streaming());
  EXPECT_EQ("", wiimote_.link().error);
  EXPECT_EQ("00:1f:32:00:00:01", wiimote_.link().identity);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  ASSERT_TRUE(wiimote_.link().status);
  EXPECT_EQ(0x8f, wiimote_.link().status->battery);
  EXPECT_TRUE(wiimote_.link().accelerometer_calibrated);
  EXPECT_EQ((std::array<int, 3>{531, 520, 536}), wiimote_.accelerometer().at_zero_g);
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(291, last_.spots[0].x);
  EXPECT_NEAR(100, run(1.0), 1);
}

TEST_F(WiimoteTest, EveryLostRequestOrAnswerIsRepeated) {
  for (const Report& lost : kHandshake) {
    FakeRemote remote;
    int losses = 2;
    remote.lose = [&](const Report& report) { return report == lost && losses-- > 0; };
    Wiimote wiimote(
        Options(), [&] { return remote.open(); }, [&] { return remote.now; });
    bool image = false;
    while (!image && remote.now < 160.0)
      image = wiimote.step(0.1).has_value();
    EXPECT_TRUE(image);
    EXPECT_EQ(3, remote.count(lost)) << "report " << int{lost.bytes[0]};
    EXPECT_EQ(1, remote.opened);
  }
}

TEST_F(WiimoteTest, ASilentRemoteIsReconnected) {
  remote_.answers = false;
  run(2.6);
  EXPECT_EQ(5, remote_.count(kStatusRequest));
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_NE(std::string::npos, wiimote_.link().error.find("does not answer report 0x15"));
  remote_.answers = true;
  runToImage();
  EXPECT_TRUE(streaming());
  EXPECT_EQ("", wiimote_.link().error);
  EXPECT_EQ(2, remote_.opened);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch) << "the first stream is epoch 0";
}

TEST_F(WiimoteTest, AnyExceptionEndsTheConnectionAndNothingElse) {
  int failures = 1;
  Wiimote wiimote(
      Options(),
      [&]() -> std::unique_ptr<transport::Transport> {
        if (failures-- > 0)
          throw std::bad_alloc();
        return remote_.open();
      },
      [&] { return remote_.now; });
  EXPECT_NO_THROW(wiimote.step(0.1));
  EXPECT_EQ(Link::State::kSearching, wiimote.link().state);
  EXPECT_NE("", wiimote.link().error);
  remote_.now += 1.0;
  remote_.lose = [](const Report&) -> bool { throw std::logic_error("of the transport"); };
  EXPECT_NO_THROW(wiimote.step(0.1));
  EXPECT_EQ("of the transport", wiimote.link().error);
  EXPECT_NO_THROW(wiimote.close());
}

TEST_F(WiimoteTest, RefusedReportsAreGivenUpWithTheReason) {
  // A remote that answers everything with error 2.
  remote_.lose = [&](const Report& report) {
    if (report.bytes[0] != 0x15)
      remote_.say({0x22, 0, 0, report.bytes[0], 0x02}, 0.005);
    return report.bytes[0] != 0x15;
  };
  run(0.2);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_NE(std::string::npos,
            wiimote_.link().error.find(
                "answers 'error 2, sent on the wrong Bluetooth channel' to report 0x11"));
}

TEST_F(WiimoteTest, NothingIsPassedOnBeforeTheCameraIsSetUp) {
  remote_.mode = 0x33;  // left behind by another program
  remote_.lose = [](const Report& report) { return report == kRun; };
  EXPECT_EQ(0, run(2.0));
  EXPECT_FALSE(streaming());
}

TEST_F(WiimoteTest, StatusThatNobodyAskedForStopsNothing) {
  runToImage();
  remote_.mode = 0x30;  // an extension was plugged in: reporting stops
  remote_.say({0x20, 0, 0, 0x1a, 0, 0, 0x8f});
  const double then = remote_.now;
  runToImage();
  EXPECT_EQ(kReport33, remote_.written.back().report);
  EXPECT_LT(remote_.now - then, 0.05);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, KernelThatResetsTheModeAfterEachStatusIsOvercome) {
  runToImage();
  // The kernel's 12 00 30 arrives after our own 0x12, and the remote sends one report 0x30.
  remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
  run(0.007);
  remote_.mode = 0x30;
  remote_.say({0x22, 0, 0, 0x12, 0});
  remote_.say({0x30, 0, 0});
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.1);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  EXPECT_EQ(0u, wiimote_.link().restorations) << "this happens every minute";
  EXPECT_EQ(1, remote_.count(kVerify));
}

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

TEST_F(WiimoteTest, RemoteThatAcknowledgesButSendsNoImagesIsGivenUp) {
  runToImage();
  remote_.lose = [&](const Report& report) {
    if (report == kReport33)
      remote_.say({0x22, 0, 0, 0x12, 0}, 0.005);
    return report == kReport33;
  };
  remote_.mode = 0x30;
  run(5.0);
  EXPECT_EQ(2, remote_.opened);
  EXPECT_NE(std::string::npos, wiimote_.link().error.find("sends no images"));
}

TEST_F(WiimoteTest, ForeignAnswersAreTolerated) {
  // Provoked by the kernel's own driver: answers to its reads and writes of extension registers,
  // before every answer to us.
  remote_.lose = [&](const Report&) {
    Report no_motion_plus{0x21, 0, 0, 0xf7, 0x00, 0xfa};
    no_motion_plus.size = 22;
    remote_.say(no_motion_plus, 0.001);
    remote_.say({0x22, 0, 0, 0x15, 0x00}, 0.001);
    remote_.say({0x22, 0, 0, 0x17, 0x04}, 0.001);
    return false;
  };
  runToImage();
  EXPECT_TRUE(wiimote_.link().accelerometer_calibrated);
  EXPECT_EQ(1, remote_.opened);
}

TEST_F(WiimoteTest, ForeignWriteErrorInTheMiddleIsOvercome) {
  int errors = 1;
  remote_.lose = [&](const Report& report) {
    if (report == kBlock1 && errors-- > 0)
      remote_.say({0x22, 0, 0, 0x16, 0x07}, 0.001);
    return false;
  };
  runToImage();
  EXPECT_EQ(2, remote_.count(kClock));
  EXPECT_EQ(3, remote_.registers[0x33]);
}

TEST_F(WiimoteTest, ForeignGoodAnswerThatHidesALostWriteIsDetected) {
  int losses = 1;
  remote_.lose = [&](const Report& report) {
    if (report == kMode && losses-- > 0) {
      remote_.say({0x22, 0, 0, 0x16, 0x00}, 0.001);
      return true;
    }
    return false;
  };
  runToImage();
  EXPECT_EQ(2, remote_.count(kMode));
  EXPECT_TRUE(last_.spots[0].seen);
}

TEST_F(WiimoteTest, CameraThatRefusesAllWritesIsGivenUpWithTheReason) {
  remote_.lose = [&](const Report& report) {
    if (report.bytes[0] == 0x16)
      remote_.say({0x22, 0, 0, 0x16, 0x07}, 0.005);
    return report.bytes[0] == 0x16;
  };
  run(0.2);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_NE(std::string::npos, wiimote_.link().error.find("camera"));
}

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

TEST_F(WiimoteTest, BusyReadIsRepeatedSoon) {
  int busy = 2;
  remote_.lose = [&](const Report& report) {
    const bool refuse = report == kReadBlock && busy-- > 0;
    if (refuse)
      remote_.say({0x22, 0, 0, 0x17, 0x04}, 0.005);
    return refuse;
  };
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.3);
  EXPECT_TRUE(wiimote_.link().accelerometer_calibrated);
}

TEST_F(WiimoteTest, DamagedCalibrationIsTakenFromItsCopy) {
  remote_.block[2] ^= 0x10;
  runToImage();
  EXPECT_EQ(1, remote_.count(kReadCopy));
  EXPECT_TRUE(wiimote_.link().accelerometer_calibrated);
  EXPECT_EQ(536, wiimote_.accelerometer().at_zero_g[2]);
}

TEST_F(WiimoteTest, WithoutCalibrationATypicalOneIsUsed) {
  remote_.block[2] ^= 0x10;
  remote_.copy[2] ^= 0x10;
  runToImage();
  EXPECT_FALSE(wiimote_.link().accelerometer_calibrated);
  EXPECT_EQ(0x200, wiimote_.accelerometer().at_zero_g[2]);
}

TEST_F(WiimoteTest, DisconnectAndReconnect) {
  runToImage();
  remote_.present = false;
  run(3.0);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_EQ("no fake remote is connected", wiimote_.link().error);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  remote_.powerCycle();
  remote_.present = true;
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 1.0) << "longest pause between attempts is 0.5 s";
  EXPECT_EQ(1u, wiimote_.link().clock_epoch);
  EXPECT_TRUE(streaming());
}

TEST_F(WiimoteTest, RemoteThatIsNotThereYetIsLookedForWithGrowingPauses) {
  FakeRemote remote;
  std::vector<double> attempts;
  Wiimote wiimote(
      Options(),
      [&]() -> std::unique_ptr<transport::Transport> {
        attempts.push_back(remote.now);
        if (attempts.size() < 7)
          throw transport::NoSuchDevice("none");
        return remote.open();
      },
      [&] { return remote.now; });
  bool image = false;
  while (!image && remote.now < 160.0) {
    remote.now += wiimote.idleTime();
    image = wiimote.step(0.1).has_value();
  }
  EXPECT_TRUE(image);
  const std::vector<double> pauses{0.25, 0.5, 0.5, 0.5, 0.5, 0.5};
  ASSERT_EQ(pauses.size() + 1, attempts.size());
  for (std::size_t i = 0; i < pauses.size(); ++i)
    EXPECT_NEAR(pauses[i], attempts[i + 1] - attempts[i], 1e-9);
}

TEST_F(WiimoteTest, BatteryIsRequestedRegularly) {
  runToImage();
  const int images = run(121.0);
  EXPECT_EQ(3, remote_.count(kStatusRequest));
  EXPECT_NEAR(12100, images, 20);
  EXPECT_EQ(kReport33, remote_.written.back().report);
}

TEST_F(WiimoteTest, CloseSwitchesTheRemoteOff) {
  runToImage();
  wiimote_.close();
  EXPECT_EQ(0x30, remote_.mode);
  EXPECT_FALSE(remote_.camera);
  EXPECT_EQ(0, remote_.leds);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  remote_.present = false;
  EXPECT_NO_THROW(wiimote_.close());
}

TEST_F(WiimoteTest, CloseOfARemoteThatHasGoneIsHarmless) {
  runToImage();
  remote_.present = false;
  EXPECT_NO_THROW(wiimote_.close());
}

TEST_F(WiimoteTest, RequestsForTheBatteryCostNoImage) {
  runToImage();
  const int images = run(59.0);
  ASSERT_EQ(1, remote_.count(kStatusRequest));
  EXPECT_NEAR(100, run(1.5) - 50, 1);
  EXPECT_EQ(2, remote_.count(kStatusRequest));
  EXPECT_NEAR(5900, images, 1);
}

TEST_F(WiimoteTest, ModeThatTheKernelResetsSilentlyAfterAStatusCostsFewImages) {
  runToImage();
  remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
  run(0.008);
  // The kernel's 12 00 30 has overtaken ours; nothing changes, so the remote sends nothing more.
  remote_.mode = 0x30;
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.045);
  EXPECT_EQ(0u, wiimote_.link().restorations);
}

TEST_F(WiimoteTest, LedsSwitchedByOthersAreSetAgainAfterTheNextStatus) {
  runToImage();
  remote_.leds = 0x8;
  run(61.0);
  EXPECT_EQ(0x1, remote_.leds);
}

// ---- The factory's calibration of the camera

TEST_F(WiimoteTest, FactoryCalibrationOfTheCamera) {
  runToImage();
  ASSERT_TRUE(wiimote_.link().ir_calibration);
  EXPECT_EQ((std::array<int, 2>{136, 645}), wiimote_.link().ir_calibration->points[0]);
  EXPECT_EQ((std::array<int, 2>{140, 57}), wiimote_.link().ir_calibration->points[3]);
  EXPECT_EQ(0, remote_.count(kReadIrCopy));
}

TEST_F(WiimoteTest, DamagedCameraCalibrationIsTakenFromItsCopy) {
  remote_.ir_block[4] ^= 0x01;
  runToImage();
  EXPECT_EQ(1, remote_.count(kReadIrCopy));
  ASSERT_TRUE(wiimote_.link().ir_calibration);
  EXPECT_EQ(907, wiimote_.link().ir_calibration->points[1][0]);
}

TEST_F(WiimoteTest, ItStreamsWithoutCameraCalibration) {
  remote_.ir_block[4] ^= 0x01;
  remote_.ir_copy[0] ^= 0x80;
  runToImage();
  EXPECT_FALSE(wiimote_.link().ir_calibration);
  EXPECT_TRUE(wiimote_.link().accelerometer_calibrated);
}

TEST_F(WiimoteTest, ItStreamsWithoutEeprom) {
  remote_.lose = [](const Report& report) {
    return report.bytes[0] == 0x17 && report.bytes[1] == 0;
  };
  runToImage();
  EXPECT_TRUE(streaming());
  EXPECT_EQ(1, remote_.opened);
  EXPECT_FALSE(wiimote_.link().ir_calibration);
  EXPECT_FALSE(wiimote_.link().accelerometer_calibrated);
}

// ---- Changes by others

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

TEST_F(WiimoteTest, StatusWithTheCameraOffCausesACheck) {
  runToImage();
  remote_.camera = false;
  remote_.say({0x20, 0, 0, 0x10, 0, 0, 0x8f});
  run(0.15);
  EXPECT_TRUE(remote_.camera);
  run(0.05);
  EXPECT_EQ("the camera was switched off", wiimote_.link().last_restoration);
}

TEST_F(WiimoteTest, RestorationsAreCountedOverReconnects) {
  for (std::uint64_t times = 1; times <= 2; ++times) {
    runToImage();
    remote_.camera = false;
    run(1.0);
    EXPECT_EQ(times, wiimote_.link().restorations);
    remote_.present = false;
    run(1.0);
    remote_.powerCycle();
    remote_.present = true;
  }
}

// Packets of somebody's reads of 16 bytes each, at addresses where ours begin as well.
TEST_F(WiimoteTest, PacketsOfForeignReadsAreNotTakenForOurs) {
  remote_.lose = [&](const Report& report) {
    if (report.bytes[0] == 0x17) {
      Report foreign{0x21, 0, 0, 0xf0, report.bytes[3], report.bytes[4], 1, 2, 3};
      foreign.size = 22;
      remote_.say(foreign, 0.001);
    }
    return false;
  };
  runToImage();
  EXPECT_TRUE(wiimote_.link().accelerometer_calibrated);
  EXPECT_TRUE(wiimote_.link().ir_calibration);
  EXPECT_EQ(0, remote_.count(kReadCopy));
  run(20.0);
  EXPECT_EQ(1, remote_.count(kClock));
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

TEST_F(WiimoteTest, TheReportRightAfterAModeIsNoNewImage) {
  runToImage();
  int images = 0;
  for (int i = 0; i < 40; ++i) {
    remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});  // the mode is then set again, and answered
    images += run(0.25);
  }
  EXPECT_NEAR(1000, images, 2);
  EXPECT_LE(40, remote_.count({0x12, 0x06, 0x33}));
}

TEST_F(WiimoteTest, AnImageAtItsRegularTimeIsNoEchoOfAMode) {
  remote_.echoes = false;
  runToImage();
  int images = 0;
  for (int i = 0; i < 40; ++i) {
    remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
    images += run(0.2513);  // at another phase between two images each time
  }
  EXPECT_NEAR(1005, images, 1);
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

// ---- What changes while it streams

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
  for (int i = 0; i < 50; ++i) {
    if (run(0.01) > 0) {
      EXPECT_TRUE(last_.spots[0].seen) << "image " << i;
    }
  }
}

TEST_F(WiimoteTest, TheLastSensitivityAppliesAtAnyMomentOfChange) {
  const protocol::IrSensitivity marcan = *protocol::irSensitivity("marcan");
  for (int i = 0; i < 240; ++i) {
    const double moment = 100.0 + 0.001 * (i / 2);
    FakeRemote remote;
    Wiimote wiimote(
        Options(), [&] { return remote.open(); }, [&] { return remote.now; });
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

// ---- Formats

Options optionsOf(protocol::IrFormat format) {
  Options options;
  options.session.ir_format = format;
  return options;
}

class BasicFormat : public WiimoteTest {
 protected:
  BasicFormat() : WiimoteTest(optionsOf(protocol::IrFormat::kBasic)) {}
};

TEST_F(BasicFormat, Streams) {
  runToImage();
  EXPECT_EQ(0x37, remote_.mode);
  EXPECT_EQ(1, remote_.registers[0x33]);
  EXPECT_NEAR(100, run(1.0), 1);
  EXPECT_EQ(protocol::IrFormat::kBasic, last_.ir_format);
  EXPECT_TRUE(last_.acceleration);
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(291, last_.spots[0].x);
  EXPECT_FALSE(last_.spots[1].seen);
  // The kernel's own way to read the camera differs in the report mode only.
  remote_.mode = 0x36;
  Report kernels{0x36, 0, 0};
  kernels.size = 22;
  remote_.say(kernels);
  run(0.1);
  EXPECT_EQ(0x37, remote_.mode);
}

class FullFormat : public WiimoteTest {
 protected:
  FullFormat() : WiimoteTest(optionsOf(protocol::IrFormat::kFull)) {}
};

TEST_F(FullFormat, StreamsCompleteImagesAtHalfTheRate) {
  runToImage();
  EXPECT_EQ(0x3e, remote_.mode);
  EXPECT_EQ(5, remote_.registers[0x33]);
  EXPECT_NEAR(50, run(1.0), 1);
  EXPECT_EQ(protocol::IrFormat::kFull, last_.ir_format);
  ASSERT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(291, last_.spots[0].x);
  EXPECT_EQ(3, last_.spots[0].size);
  EXPECT_EQ(200, last_.spots[0].intensity);
  EXPECT_EQ((std::array<int, 4>{35, 7, 37, 9}), last_.spots[0].box);
  EXPECT_FALSE(last_.spots[2].seen);
  ASSERT_TRUE(last_.acceleration);
  EXPECT_NEAR(500, run(10.0), 5);
  EXPECT_EQ(0u, wiimote_.link().restorations);
}

TEST_F(FullFormat, OtherReportIdsAreCorrected) {
  runToImage();
  remote_.mode = 0x33;
  run(0.1);
  EXPECT_EQ(0x3e, remote_.mode);
  EXPECT_NEAR(50, run(1.0), 2);
}

TEST(Format, MustBeChosen) {
  EXPECT_THROW(Session(
                   optionsOf(protocol::IrFormat::kNone).session, [](const Report&) {}, 0.0),
               std::invalid_argument);
}

// ---- Hostile remotes

TEST(HostileRemote, EachReportCausesFewWritesAndEveryWaitEnds) {
  std::mt19937 random(11);
  int sessions = 0;
  for (int i = 0; i < 300; ++i) {
    SessionOptions options;
    options.ir_format =
        std::array<protocol::IrFormat, 3>{protocol::IrFormat::kBasic, protocol::IrFormat::kExtended,
                                          protocol::IrFormat::kFull}[random() % 3];
    Report asked;
    int written = 0;
    double now = 0.0;
    try {
      Session session(
          options,
          [&](const Report& report) {
            asked = report;
            ++written;
          },
          now);
      ++sessions;
      for (int j = 0; j < 2000; ++j) {
        // Mostly likely answers, sometimes far from them.
        Report report;
        report.size = Report::kCapacity;
        for (std::uint8_t& byte : report.bytes)
          byte = static_cast<std::uint8_t>(random());
        report.bytes[0] = static_cast<std::uint8_t>(
            random() % 8 == 0 ? random() : 0x20 + (random() % 3 == 0 ? 0x10 : 0) + random() % 3);
        if (report.bytes[0] == 0x22 && random() % 8 != 0) {
          report.bytes[3] = asked.bytes[0];
          report.bytes[4] = random() % 4 == 0 ? 7 : 0;
        } else if (report.bytes[0] == 0x21 && random() % 8 != 0) {
          report.bytes[3] = static_cast<std::uint8_t>((asked.bytes[6] + 15) % 16 << 4);
          report.bytes[4] = asked.bytes[3];
          report.bytes[5] = asked.bytes[4];
        }
        written = 0;
        session.handle(report, now);
        session.tick(now);
        EXPECT_LE(written, 6);
        now += 0.001 * static_cast<double>(random() % 20);
      }
    } catch (const SessionError&) {
      // Giving up is as good as streaming.
    }
  }
  EXPECT_EQ(300, sessions);
}

TEST(HostileRemote, OneThatNeverSendsAnImageIsGivenUpWhateverElseItSends) {
  // Always answers as asked, but with these reports all the time.
  for (const Report& noise : std::vector<Report>{{0x30, 0, 0},
                                                 {0x31, 0, 0, 0, 0, 0},
                                                 {0x20, 0, 0, 0x18, 0, 0, 0x8f},
                                                 {0x22, 0, 0, 0x12, 0},
                                                 {0x22, 0, 0, 0x17, 4},
                                                 {0x3f, 0, 0},
                                                 {0x33, 0}}) {
    FakeRemote remote;
    Wiimote wiimote(
        Options(), [&] { return remote.open(); }, [&] { return remote.now; });
    remote.lose = [&](const Report& report) {
      if (report.bytes[0] == 0x12)
        remote.say({0x22, 0, 0, 0x12, 0}, 0.005);
      return report.bytes[0] == 0x12;
    };
    double next_noise = remote.now;
    while (remote.opened < 2 && remote.now < 160.0) {
      if (remote.now >= next_noise) {
        remote.say(noise);
        next_noise = remote.now + 0.01;
      }
      wiimote.step(std::max(0.001, std::min(0.01, next_noise - remote.now)));
      if (wiimote.idleTime() > 0.0)
        remote.now += wiimote.idleTime();
    }
    EXPECT_EQ(2, remote.opened) << "noise " << int{noise.bytes[0]};
    EXPECT_FALSE(wiimote.link().error.empty());
  }
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
