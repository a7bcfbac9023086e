// How the driver brings a remote to sending images and keeps it there: in fake time, against a
// remote that loses, refuses, forgets and goes away.
#include "fake_remote.h"
#include "wiimote_tracker_driver/wiimote/wiimote.h"

#include <gtest/gtest.h>

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
const Report kReport33{0x12, 0x06, 0x33};

const std::vector<Report> kHandshake{kStatusRequest, kLedOne, kReadBlock, kClock,
                                     kLogic,         kSetup,  kBlock1,    kBlock2,
                                     kMode,          kRun,    kVerify,    kReport33};

class WiimoteTest : public testing::Test {
 protected:
  WiimoteTest()
      : wiimote_(
            Options(),
            [this] { return remote_.open(); },
            [this] { return remote_.now; }) {}

  /// Lets time pass. @returns the number of images.
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

TEST_F(WiimoteTest, SilentRemoteIsGivenUpAndTriedAgain) {
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

TEST_F(WiimoteTest, RefusedReportsAreGivenUpWithTheReason) {
  // A remote that answers everything with error 2.
  remote_.lose = [&](const Report& report) {
    if (report.bytes[0] != 0x15)
      remote_.say({0x22, 0, 0, report.bytes[0], 0x02}, 0.005);
    return report.bytes[0] != 0x15;
  };
  run(0.2);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_NE(std::string::npos, wiimote_.link().error.find("refuses report 0x11"));
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
  // The kernel's 12 00 30 arrives after our own 0x12, and the remote says one report 0x30.
  remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
  run(0.007);
  remote_.mode = 0x30;
  remote_.say({0x22, 0, 0, 0x12, 0});
  remote_.say({0x30, 0, 0});
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.1);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
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

TEST_F(WiimoteTest, DarknessAloneStopsNoImageAndIsCheckedEverMoreRarely) {
  remote_.light = false;
  runToImage();
  const int images = run(100.0);
  EXPECT_NEAR(10000, images, 50);
  EXPECT_EQ(1, remote_.count(kClock));
  // At 0.5, 1.5, 3.5, 7.5, 15.5, 31.5, 63.5, 95.5 s.
  EXPECT_EQ(1 + 8, remote_.count(kVerify));
}

TEST_F(WiimoteTest, LostModeIsSetAgainAfterSilence) {
  runToImage();
  remote_.mode = 0x30;
  const double then = remote_.now;
  runToImage();
  EXPECT_NEAR(0.5, remote_.now - then, 0.05);
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
  // What the kernel's own driver provokes: answers to its reads and writes of extension registers,
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

TEST_F(WiimoteTest, ForeignGoodAnswerThatHidesALostWriteIsFoundOut) {
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
  // Silence then cannot be looked into, so everything is set up again.
  remote_.powerCycle();
  run(0.8);
  EXPECT_TRUE(streaming());
  EXPECT_TRUE(last_.spots[0].seen);
  EXPECT_EQ(1u, wiimote_.link().clock_epoch);
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

TEST_F(WiimoteTest, WithoutCalibrationATypicalOneServes) {
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

TEST_F(WiimoteTest, BatteryIsAskedForFromTimeToTime) {
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

}  // namespace
}  // namespace wiimote_tracker::wiimote
