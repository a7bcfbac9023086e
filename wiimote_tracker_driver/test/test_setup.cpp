// How the driver sets a remote up, in fake time: order, losses, refusals, answers to others,
// factory calibration, formats.
#include "wiimote_fixture.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

TEST_F(WiimoteTest, HandshakeInOrderEachStepAfterTheAnswerToTheLast) {
  runToImage();
  ASSERT_EQ(kHandshake.size(), remote_.written.size());
  for (std::size_t i = 0; i < kHandshake.size(); ++i) {
    EXPECT_EQ(kHandshake[i], remote_.written[i].report) << "step " << i;
    EXPECT_NEAR(100.0 + 0.005 * static_cast<double>(i), remote_.written[i].time, 1e-9);
  }
  EXPECT_TRUE(streaming());
  EXPECT_EQ("", wiimote_.link().error);
  EXPECT_EQ("00:1f:32:00:00:01", wiimote_.link().remote.identity);
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
        Options(), [&](bool) { return remote.open(); }, [&] { return remote.now; });
    bool image = false;
    while (!image && remote.now < 160.0)
      image = wiimote.step(0.1).has_value();
    EXPECT_TRUE(image);
    EXPECT_EQ(3, remote.count(lost)) << "report " << int{lost.bytes[0]};
    EXPECT_EQ(1, remote.opened);
  }
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

TEST_F(WiimoteTest, RemoteThatDoesNotAcknowledgeCommandsStreams) {
  for (const std::set<std::uint8_t>& silent :
       {std::set<std::uint8_t>{0x11}, {0x12}, {0x13}, {0x1a}, {0x11, 0x12, 0x13, 0x1a}}) {
    FakeRemote remote;
    remote.unacknowledged = silent;
    Wiimote wiimote(
        Options(), [&](bool) { return remote.open(); }, [&] { return remote.now; });
    int images = 0;
    while (remote.now < 230.0) {
      remote.now += wiimote.idleTime();
      images += wiimote.step(0.1).has_value();
    }
    EXPECT_EQ(1, remote.opened) << "first silent: " << int{*silent.begin()};
    EXPECT_GT(images, 12500) << "in 130 s, of which the set-up may take 5";
    EXPECT_EQ(1, remote.leds);
  }
}

TEST_F(WiimoteTest, NothingIsPassedOnBeforeTheCameraIsSetUp) {
  remote_.mode = 0x33;  // left behind by another program
  remote_.lose = [](const Report& report) { return report == kRun; };
  EXPECT_EQ(0, run(2.0));
  EXPECT_FALSE(streaming());
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

TEST_F(WiimoteTest, AcknowledgedStatusRequestHasNoStatusYet) {
  int losses = 1;
  remote_.lose = [&](const Report& report) {
    if (report == kStatusRequest && losses-- > 0) {
      remote_.say({0x22, 0, 0, 0x15, 0x00}, 0.001);
      return true;
    }
    return false;
  };
  runToImage();
  EXPECT_EQ(2, remote_.count(kStatusRequest));
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

Options optionsOf(protocol::IrFormat format) {
  Options options;
  options.ir_format = format;
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
                   optionsOf(protocol::IrFormat::kNone), [](const Report&) {}, 0.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
