// The virtual Wii Remote spoken to in raw bytes, as documented for the real one.
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::virtual_wiimote {
namespace {

using Answers = std::vector<Bytes>;

/// A register or EEPROM write as it crosses the wire, 22 bytes.
Bytes write(std::uint8_t flags, Bytes address, Bytes payload) {
  Bytes report{0x16, flags};
  report.insert(report.end(), address.begin(), address.end());
  report.push_back(static_cast<std::uint8_t>(payload.size()));
  report.insert(report.end(), payload.begin(), payload.end());
  report.resize(22, 0);
  return report;
}

const Bytes kClockOn{0x13, 0x06};
const Bytes kLogicOn{0x1a, 0x06};
const Bytes kBegin = write(0x04, {0xb0, 0x00, 0x30}, {0x01});
const Bytes kBlock1 =
    write(0x04, {0xb0, 0x00, 0x00}, {0x02, 0, 0, 0x71, 0x01, 0x00, 0xaa, 0x00, 0x64});
const Bytes kBlock2 = write(0x04, {0xb0, 0x00, 0x1a}, {0x63, 0x03});
const Bytes kExtended = write(0x04, {0xb0, 0x00, 0x33}, {0x03});
const Bytes kBasic = write(0x04, {0xb0, 0x00, 0x33}, {0x01});
const Bytes kRun = write(0x04, {0xb0, 0x00, 0x30}, {0x08});
const Bytes kReport33{0x12, 0x04, 0x33};

std::vector<Bytes> handshake() {
  return {kClockOn, kLogicOn, kBegin, kBlock1, kBlock2, kExtended, kRun, kReport33};
}

Senses lights(std::vector<Light> lights) {
  Senses senses;
  senses.lights = std::move(lights);
  return senses;
}

/// The infrared bytes of the report sent for these lights after all of `outputs`.
Bytes infraredAfter(const std::vector<Bytes>& outputs, const Senses& senses) {
  Device device;
  for (const Bytes& output : outputs)
    device.handleOutput(output);
  const std::optional<Bytes> report = device.sample(senses);
  if (!report || report->at(0) != 0x33)
    return {};
  return Bytes(report->begin() + 6, report->end());
}

// Golden vector of the extended format: sizes 3, 1, 15; the fourth slot never had a light.
const Senses kThreeLights = lights({{291, 69, 3, 9}, {1023, 767, 1, 8}, {512, 384, 15, 7}});
const Bytes kThreeExtended{0x23, 0x45, 0x13, 0xff, 0xff, 0xb1, 0x00, 0x80, 0x6f, 0, 0, 0};

TEST(Handshake, RightOneGivesInfrared) {
  EXPECT_EQ(kThreeExtended, infraredAfter(handshake(), kThreeLights));
}

TEST(Handshake, AnyStepLeftOutGivesNone) {
  const Bytes nothing(12, 0xff);
  // All but the first write of register 0x30 and the report mode itself.
  for (const std::size_t left_out : {0u, 1u, 3u, 4u, 5u, 6u}) {
    std::vector<Bytes> outputs = handshake();
    outputs.erase(outputs.begin() + static_cast<std::ptrdiff_t>(left_out));
    EXPECT_EQ(nothing, infraredAfter(outputs, kThreeLights)) << "without step " << left_out;
  }
}

TEST(Handshake, WrongValuesGiveNone) {
  const Bytes nothing(12, 0xff);
  const auto replaced = [](std::size_t step, const Bytes& by) {
    std::vector<Bytes> outputs = handshake();
    outputs[step] = by;
    return outputs;
  };
  EXPECT_EQ(nothing, infraredAfter(replaced(0, {0x13, 0x02}), kThreeLights));
  EXPECT_EQ(nothing, infraredAfter(replaced(1, {0x1a, 0x00}), kThreeLights));
  for (const std::uint8_t mode : {0x00, 0x02, 0x04, 0x06}) {
    EXPECT_EQ(nothing,
              infraredAfter(replaced(5, write(0x04, {0xb0, 0x00, 0x33}, {mode})), kThreeLights));
  }
  EXPECT_EQ(nothing,
            infraredAfter(replaced(6, write(0x04, {0xb0, 0x00, 0x30}, {0x01})), kThreeLights));
  // The flag for register space missing: the write went to the EEPROM's address space.
  EXPECT_EQ(nothing,
            infraredAfter(replaced(6, write(0x00, {0xb0, 0x00, 0x30}, {0x08})), kThreeLights));
  // Registers written before the camera was on the bus.
  std::vector<Bytes> outputs{kBegin, kBlock1,  kBlock2,  kExtended,
                             kRun,   kClockOn, kLogicOn, kReport33};
  EXPECT_EQ(nothing, infraredAfter(outputs, kThreeLights));
}

TEST(Handshake, CameraSwitchedOffLater) {
  std::vector<Bytes> outputs = handshake();
  outputs.push_back({0x13, 0x00});
  EXPECT_EQ(Bytes(12, 0xff), infraredAfter(outputs, kThreeLights));
}

TEST(Handshake, MirroredRegistersAndOtherFlagWork) {
  std::vector<Bytes> outputs = handshake();
  outputs[6] = write(0x08, {0xb0, 0x01, 0x30}, {0x08});
  EXPECT_EQ(kThreeExtended, infraredAfter(outputs, kThreeLights));
}

TEST(Registers, DisabledCameraAnswersWithError7) {
  Device device;
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x07}}), device.handleOutput(kRun));
  EXPECT_EQ(
      (Answers{{0x21, 0, 0, 0xf7, 0x00, 0x30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}),
      device.handleOutput({0x17, 0x04, 0xb0, 0x00, 0x30, 0x00, 0x04}));
  device.handleOutput(kClockOn);
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x00}}), device.handleOutput(kRun));
  EXPECT_EQ(
      (Answers{{0x21, 0, 0, 0x30, 0x00, 0x30, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}),
      device.handleOutput({0x17, 0x04, 0xb0, 0x00, 0x30, 0x00, 0x04}));
}

TEST(Registers, NoExtensionNoMotionPlus) {
  Device device;
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x07}}),
            device.handleOutput(write(0x04, {0xa4, 0x00, 0xf0}, {0x55})));
  const Answers answers = device.handleOutput({0x17, 0x04, 0xa6, 0x00, 0xfa, 0x00, 0x06});
  ASSERT_EQ(1u, answers.size());
  EXPECT_EQ((Bytes{0x21, 0, 0, 0xf7, 0x00, 0xfa}),
            Bytes(answers[0].begin(), answers[0].begin() + 6));
}

TEST(Eeprom, AccelerometerBlockAndItsCopy) {
  Device device;
  EXPECT_EQ((Answers{{0x21, 0,    0,    0x90, 0x00, 0x16, 0x84, 0x82, 0x86, 0x30, 0x9f,
                      0x9d, 0x9f, 0x02, 0x40, 0x2e, 0,    0,    0,    0,    0,    0}}),
            device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x0a}));
  EXPECT_EQ((Answers{{0x21, 0,    0,    0x90, 0x00, 0x20, 0x84, 0x82, 0x86, 0x30, 0x9f,
                      0x9d, 0x9f, 0x02, 0x40, 0x2e, 0,    0,    0,    0,    0,    0}}),
            device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x20, 0x00, 0x0a}));
}

TEST(Eeprom, InfraredBlock) {
  Device device;
  EXPECT_EQ((Answers{{0x21, 0,    0,    0xa0, 0x00, 0x00, 0x88, 0x85, 0x8b, 0x8b, 0x8a,
                      0x97, 0x3f, 0x30, 0x8c, 0x39, 0xcd, 0,    0,    0,    0,    0}}),
            device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x00, 0x00, 0x0b}));
}

TEST(Eeprom, OutOfRangeIsError8EvenIfTheStartExists) {
  Device device;
  const Answers beyond = device.handleOutput({0x17, 0x00, 0x00, 0x16, 0xf0, 0x00, 0x11});
  ASSERT_EQ(1u, beyond.size());
  EXPECT_EQ((Bytes{0x21, 0, 0, 0xf8, 0x16, 0xf0}), Bytes(beyond[0].begin(), beyond[0].begin() + 6));
  const Answers last = device.handleOutput({0x17, 0x00, 0x00, 0x16, 0xf0, 0x00, 0x10});
  ASSERT_EQ(1u, last.size());
  EXPECT_EQ(0xf0, last[0][3]);
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x08}}),
            device.handleOutput(write(0x00, {0x00, 0x17, 0x00}, {1})));
}

TEST(Eeprom, WrittenBytesSurviveChangeOfBatteries) {
  Device device;
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x00}}),
            device.handleOutput(write(0x00, {0x00, 0x10, 0x00}, {0xab, 0xcd})));
  device.powerCycle();
  const Answers answers = device.handleOutput({0x17, 0x00, 0x00, 0x10, 0x00, 0x00, 0x02});
  ASSERT_EQ(1u, answers.size());
  EXPECT_EQ((Bytes{0x21, 0, 0, 0x10, 0x10, 0x00, 0xab, 0xcd, 0}),
            Bytes(answers[0].begin(), answers[0].begin() + 9));
}

TEST(Read, LongReadTakesThePlaceOfDataReportsAndIsExclusive) {
  Device device;
  for (const Bytes& output : handshake())
    device.handleOutput(output);
  const Answers first = device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x00, 0x00, 0x28});
  ASSERT_EQ(1u, first.size());
  EXPECT_EQ((Bytes{0x21, 0, 0, 0xf0, 0x00, 0x00}), Bytes(first[0].begin(), first[0].begin() + 6));
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x17, 0x04}}),
            device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x0a}));
  const std::optional<Bytes> second = device.sample(kThreeLights);
  ASSERT_TRUE(second);
  EXPECT_EQ((Bytes{0x21, 0, 0, 0xf0, 0x00, 0x10}), Bytes(second->begin(), second->begin() + 6));
  const std::optional<Bytes> third = device.sample(kThreeLights);
  ASSERT_TRUE(third);
  EXPECT_EQ((Bytes{0x21, 0, 0, 0x70, 0x00, 0x20}), Bytes(third->begin(), third->begin() + 6));
  EXPECT_EQ(0x33, device.sample(kThreeLights)->at(0));
}

TEST(Write, EmptyOrTooLongIsIgnored) {
  Device device;
  Bytes report = write(0x00, {0, 0, 0}, {1});
  report[5] = 0;
  EXPECT_TRUE(device.handleOutput(report).empty());
  report[5] = 17;
  EXPECT_TRUE(device.handleOutput(report).empty());
}

TEST(Acknowledgement, OnlyOnRequestExceptForWrites) {
  Device device;
  EXPECT_TRUE(device.handleOutput({0x11, 0x10}).empty());
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x11, 0x00}}), device.handleOutput({0x11, 0x12}));
  EXPECT_TRUE(device.handleOutput({0x13, 0x04}).empty());
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x1a, 0x00}}), device.handleOutput({0x1a, 0x06}));
  EXPECT_TRUE(device.handleOutput({0x10, 0x03}).empty());
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x00}}),
            device.handleOutput(write(0x04, {0xb0, 0x00, 0x30}, {0x01})));
}

TEST(Status, SaysLedsCameraAndBattery) {
  Device::Options options;
  options.battery = 0x8f;
  Device device(options);
  EXPECT_EQ((Answers{{0x20, 0, 0, 0x00, 0, 0, 0x8f}}), device.handleOutput({0x15, 0x00}));
  device.handleOutput({0x11, 0x40});
  device.handleOutput(kClockOn);
  EXPECT_EQ((Answers{{0x20, 0, 0, 0x48, 0, 0, 0x8f}}), device.handleOutput({0x15, 0x00}));
  EXPECT_EQ(0x04, device.leds());

  options.battery = 0x10;
  Device empty(options);
  EXPECT_EQ((Answers{{0x20, 0, 0, 0x01, 0, 0, 0x10}}), empty.handleOutput({0x15, 0x00}));
}

TEST(Mode, UnknownIsIgnoredAltogether) {
  Device device;
  EXPECT_TRUE(device.handleOutput({0x12, 0x06, 0x29}).empty());
  EXPECT_TRUE(device.handleOutput({0x12, 0x06, 0x38}).empty());
  Senses senses;
  senses.buttons = 0x0008;
  EXPECT_EQ((Bytes{0x30, 0x00, 0x08}), device.sample(senses));
}

TEST(Mode, OneReportFollowsTheAcknowledgement) {
  Device device;
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x12, 0x00}, {0x30, 0, 0}}),
            device.handleOutput({0x12, 0x02, 0x30}));
}

TEST(Mode, NotContinuousReportsOnlyChanges) {
  Device device;
  device.handleOutput({0x12, 0x00, 0x30});
  Senses senses;
  EXPECT_FALSE(device.sample(senses));
  senses.buttons = 0x1000;
  EXPECT_EQ((Bytes{0x30, 0x10, 0x00}), device.sample(senses));
  EXPECT_FALSE(device.sample(senses));
  device.handleOutput({0x12, 0x04, 0x30});
  EXPECT_EQ((Bytes{0x30, 0x10, 0x00}), device.sample(senses));
  EXPECT_EQ((Bytes{0x30, 0x10, 0x00}), device.sample(senses));
}

TEST(Mode, LengthsOfAllReports) {
  const std::vector<std::pair<std::uint8_t, std::size_t>> sizes{
      {0x30, 3}, {0x31, 6}, {0x32, 11}, {0x33, 18}, {0x34, 22}, {0x35, 22}, {0x36, 22}, {0x37, 22}};
  for (const auto& size : sizes) {
    Device device;
    device.handleOutput({0x12, 0x04, size.first});
    const std::optional<Bytes> report = device.sample(Senses());
    ASSERT_TRUE(report);
    EXPECT_EQ(size.first, report->at(0));
    EXPECT_EQ(size.second, report->size());
  }
}

TEST(Accelerometer, FactoryCalibrationAndBitLayout) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x31});
  // At 0 g: x = 0x213, y = 0x208, z = 0x218; z reads 0x27e at 1 g.
  Senses senses;
  senses.acceleration = {0, 0, 0};
  EXPECT_EQ((Bytes{0x31, 0x60, 0x00, 0x84, 0x82, 0x86}), device.sample(senses));
  senses.acceleration = {0, 0, 1};
  EXPECT_EQ((Bytes{0x31, 0x60, 0x40, 0x84, 0x82, 0x9f}), device.sample(senses));
  senses.acceleration = {-100, 100, 0};  // clipped, y and z have no lowest bit
  EXPECT_EQ((Bytes{0x31, 0x00, 0x20, 0x00, 0xff, 0x86}), device.sample(senses));
}

TEST(Infrared, BasicGoldenVectorInReport37And36) {
  Device device;
  for (const Bytes& output : {kClockOn, kLogicOn, kBegin, kBlock1, kBlock2, kBasic, kRun})
    device.handleOutput(output);
  device.handleOutput({0x12, 0x04, 0x37});
  device.sample(lights({{1, 1, 1, 1}, {300, 1, 1, 1}, {600, 1, 1, 1}, {900, 1, 1, 1}}));
  device.sample(Senses());  // every slot has had a light and lost it
  std::optional<Bytes> report = device.sample(kThreeLights);
  ASSERT_TRUE(report);
  const Bytes golden{0x23, 0x45, 0x1b, 0xff, 0xff, 0x00, 0x80, 0x6f, 0xff, 0xff};
  EXPECT_EQ(golden, Bytes(report->begin() + 6, report->begin() + 16));
  device.handleOutput({0x12, 0x04, 0x36});
  report = device.sample(kThreeLights);
  ASSERT_TRUE(report);
  EXPECT_EQ(golden, Bytes(report->begin() + 3, report->begin() + 13));
}

TEST(Infrared, MismatchedModesCopyTheRegistersAsTheyAre) {
  // Extended data read through the ten bytes of report 0x37.
  std::vector<Bytes> outputs = handshake();
  outputs.back() = {0x12, 0x04, 0x37};
  Device device;
  for (const Bytes& output : outputs)
    device.handleOutput(output);
  const std::optional<Bytes> report = device.sample(kThreeLights);
  ASSERT_TRUE(report);
  EXPECT_EQ(Bytes(kThreeExtended.begin(), kThreeExtended.begin() + 10),
            Bytes(report->begin() + 6, report->begin() + 16));
  // Basic data read through the twelve bytes of report 0x33.
  outputs = handshake();
  outputs[5] = kBasic;
  const Bytes infrared = infraredAfter(outputs, kThreeLights);
  ASSERT_EQ(12u, infrared.size());
  EXPECT_EQ((Bytes{0x23, 0x45, 0x1b, 0xff, 0xff}), Bytes(infrared.begin(), infrared.begin() + 5));
  EXPECT_EQ((Bytes{0xff, 0xff}), Bytes(infrared.begin() + 10, infrared.end()));
}

/// A device that has gone through the handshake.
class Seeing : public testing::Test {
 protected:
  void SetUp() override {
    for (const Bytes& output : handshake())
      device.handleOutput(output);
  }

  /// The three bytes of one slot.
  Bytes slot(const Bytes& report, std::size_t index) const {
    const auto begin = report.begin() + 6 + 3 * static_cast<std::ptrdiff_t>(index);
    return Bytes(begin, begin + 3);
  }

  Device device;
  const Bytes never{0, 0, 0};
  const Bytes lost{0xff, 0xff, 0xff};
};

TEST_F(Seeing, QuantisesToTheNearestPixel) {
  const Bytes report = *device.sample(lights({{100.49, 50.51, 2, 1}}));
  EXPECT_EQ((Bytes{100, 51, 0x02}), slot(report, 0));
}

TEST_F(Seeing, OutOfTheImageIsNotSeen) {
  const Bytes report = *device.sample(
      lights({{-0.6, 5, 2, 1}, {1023.6, 5, 2, 1}, {5, -0.6, 2, 1}, {5, 767.6, 2, 1}}));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(never, slot(report, i));
}

TEST_F(Seeing, FourBrightestOnly) {
  const Bytes report = *device.sample(
      lights({{10, 0, 1, 5}, {20, 0, 1, 1}, {30, 0, 1, 4}, {40, 0, 1, 3}, {50, 0, 1, 2}}));
  EXPECT_EQ(10, slot(report, 0)[0]);
  EXPECT_EQ(30, slot(report, 1)[0]);
  EXPECT_EQ(40, slot(report, 2)[0]);
  EXPECT_EQ(50, slot(report, 3)[0]);
}

TEST_F(Seeing, LightKeepsItsSlotWhileFollowed) {
  device.sample(lights({{100, 100, 2, 2}, {200, 100, 2, 1}}));
  // The second becomes the brighter one, both move, and are listed the other way round.
  Bytes report = *device.sample(lights({{205, 100, 2, 9}, {105, 100, 2, 1}}));
  EXPECT_EQ(105, slot(report, 0)[0]);
  EXPECT_EQ(205, slot(report, 1)[0]);
  // The first goes out: its slot stays empty, the second stays in its own.
  report = *device.sample(lights({{205, 100, 2, 9}}));
  EXPECT_EQ(lost, slot(report, 0));
  EXPECT_EQ(205, slot(report, 1)[0]);
  EXPECT_EQ(never, slot(report, 2));
  // A new one takes the first free slot.
  report = *device.sample(lights({{205, 100, 2, 9}, {50, 700, 2, 1}}));
  EXPECT_EQ(50, slot(report, 0)[0]);
}

TEST_F(Seeing, PowerCycleForgetsAll) {
  device.sample(kThreeLights);
  device.handleOutput({0x11, 0x10});
  device.powerCycle();
  EXPECT_EQ(0, device.leds());
  Senses senses = kThreeLights;
  senses.buttons = 0x0100;
  EXPECT_EQ((Bytes{0x30, 0x01, 0x00}), device.sample(senses));
  EXPECT_FALSE(device.sample(senses));
  device.handleOutput(kReport33);
  const std::optional<Bytes> report = device.sample(senses);
  ASSERT_TRUE(report);
  EXPECT_EQ(Bytes(12, 0xff), Bytes(report->begin() + 6, report->end()));
}

TEST(Robustness, ShortAndForeignReportsAreIgnored) {
  Device device;
  for (unsigned id = 0; id < 256; ++id) {
    if (id == 0x15)
      continue;
    EXPECT_TRUE(device.handleOutput({static_cast<std::uint8_t>(id)}).empty());
  }
  EXPECT_TRUE(device.handleOutput({}).empty());
  EXPECT_TRUE(device.handleOutput({0x16, 0x04, 0xb0, 0x00}).empty());
  EXPECT_TRUE(device.handleOutput({0x17, 0x04, 0xb0, 0x00, 0x30}).empty());
  EXPECT_TRUE(device.handleOutput({0x12, 0x06}).empty());
  EXPECT_TRUE(device.handleOutput({0x40, 0x06, 0x00}).empty());
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
