// The virtual Wii Remote by its raw bytes, as documented for the real one.
#include "virtual_remote_bytes.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::virtual_wiimote {
namespace {

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

TEST(Handshake, CorrectOneGivesInfrared) {
  EXPECT_EQ(kThreeExtended, infraredAfter(handshake(), kThreeLights));
}

TEST(Handshake, AnyMissingStepGivesNone) {
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

TEST(Read, OfNothingIsIgnored) {
  Device device;
  EXPECT_TRUE(device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x00}).empty());
  EXPECT_TRUE(device.handleOutput({0x17, 0x04, 0xb0, 0x00, 0x30, 0x00, 0x00}).empty());
}

TEST(Read, SpaceThatDoesNotExistIsError6) {
  Device device;
  device.handleOutput(kClockOn);
  const Answers answers = device.handleOutput({0x17, 0x0c, 0xb0, 0x00, 0x30, 0x00, 0x01});
  ASSERT_EQ(1u, answers.size());
  EXPECT_EQ((Bytes{0x21, 0, 0, 0xf6, 0x00, 0x30}),
            Bytes(answers[0].begin(), answers[0].begin() + 6));
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x06}}),
            device.handleOutput(write(0x0c, {0xb0, 0x00, 0x30}, {1})));
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

TEST(Status, BatteryRunsDown) {
  Device device;
  device.setBattery(0x20);
  EXPECT_EQ((Answers{{0x20, 0, 0, 0x00, 0, 0, 0x20}}), device.handleOutput({0x15, 0x00}));
  device.setBattery(0x1f);
  EXPECT_EQ((Answers{{0x20, 0, 0, 0x01, 0, 0, 0x1f}}), device.handleOutput({0x15, 0x00}));
}

TEST(Rumble, IsInEveryOutputReport) {
  const std::vector<Bytes> reports{{0x10, 0x00},
                                   {0x11, 0x10},
                                   {0x12, 0x00, 0x30},
                                   {0x13, 0x00},
                                   {0x14, 0x00},
                                   {0x15, 0x00},
                                   write(0x00, {0, 0x10, 0}, {1}),
                                   {0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x0a},
                                   {0x19, 0x00},
                                   {0x1a, 0x00}};
  for (const Bytes& without : reports) {
    Device device;
    Bytes with = without;
    with[1] |= 0x01;
    device.handleOutput(with);
    EXPECT_TRUE(device.rumble()) << int{with[0]};
    device.handleOutput(without);
    EXPECT_FALSE(device.rumble()) << int{with[0]};
  }
}

TEST(Mode, UnknownIsIgnoredAltogether) {
  Device device;
  EXPECT_TRUE(device.handleOutput({0x12, 0x06, 0x29}).empty());
  EXPECT_TRUE(device.handleOutput({0x12, 0x07, 0x38}).empty());
  EXPECT_FALSE(device.rumble());
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

TEST(Mode, PairOfReportsIsOneSample) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x3e});
  device.sample(Senses());
  Senses senses;
  senses.acceleration = {8.0 / 105.0, -10.0 / 108.0, 82.0 / 102.0};
  senses.buttons = 0x0100;
  Bytes report = *device.sample(senses);
  EXPECT_EQ((Bytes{0x3e, 0x21, 0x40, 0x86}), Bytes(report.begin(), report.begin() + 4));
  EXPECT_EQ(Bytes(18, 0xff), Bytes(report.begin() + 4, report.end()));
  // Buttons are always new; the acceleration is the one of the first half.
  report = *device.sample(Senses());
  EXPECT_EQ((Bytes{0x3f, 0x40, 0x40, 0x7f}), Bytes(report.begin(), report.begin() + 4));
  EXPECT_EQ(0x3e, device.sample(Senses())->at(0));
}

TEST(Mode, EachPairOfBitsOfTheSplitAccelerationHasItsPlace) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x3e});
  device.sample(Senses());
  Senses senses;
  senses.acceleration = {0, 0, -80.0 / 102.0};  // z = 0x1c8, of which 01 11 00 10 are sent
  const Bytes first = *device.sample(senses);
  const Bytes second = *device.sample(senses);
  EXPECT_EQ((Bytes{0x3e, 0x60, 0x20, 0x84}), Bytes(first.begin(), first.begin() + 4));
  EXPECT_EQ((Bytes{0x3f, 0x40, 0x00, 0x82}), Bytes(second.begin(), second.begin() + 4));
}

TEST(Mode, PairOnlyOnChanges) {
  Device device;
  EXPECT_EQ(0x3e, device.handleOutput({0x12, 0x00, 0x3e}).at(0).at(0));
  EXPECT_EQ(0x3f, device.sample(Senses())->at(0));
  EXPECT_FALSE(device.sample(Senses()));
  Senses senses;
  senses.acceleration = {0, 1, 0};  // y is in the second half only
  EXPECT_EQ(0x3e, device.sample(senses)->at(0));
  EXPECT_EQ(0x3f, device.sample(senses)->at(0));
  EXPECT_FALSE(device.sample(senses));
}

TEST(Mode, ExtensionAloneComesWithoutButtons) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x3d});
  Senses senses;
  senses.buttons = 0x1f9f;
  Bytes expected(22, 0xff);
  expected[0] = 0x3d;
  EXPECT_EQ(expected, device.sample(senses));
}

TEST(Mode, LengthsOfAllReports) {
  const std::vector<std::pair<std::uint8_t, std::size_t>> sizes{{0x30, 3},  {0x31, 6},  {0x32, 11},
                                                                {0x33, 18}, {0x34, 22}, {0x35, 22},
                                                                {0x36, 22}, {0x37, 22}, {0x3d, 22}};
  for (const auto& size : sizes) {
    Device device;
    device.handleOutput({0x12, 0x04, size.first});
    const std::optional<Bytes> report = device.sample(Senses());
    ASSERT_TRUE(report);
    EXPECT_EQ(size.first, report->at(0));
    EXPECT_EQ(size.second, report->size());
  }
}

TEST(Accelerometer, GoldenVector) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x31});
  // x = 0x21b, y = 0x1fe, z = 0x26a.
  Senses senses;
  senses.acceleration = {8.0 / 105.0, -10.0 / 108.0, 82.0 / 102.0};
  EXPECT_EQ((Bytes{0x31, 0x60, 0x60, 0x86, 0x7f, 0x9a}), device.sample(senses));
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
  // Full data read through report 0x33, extended data through 0x3e.
  outputs = handshake();
  outputs[5] = kFull;
  const Bytes cut = infraredAfter(outputs, kThreeLights);
  ASSERT_EQ(12u, cut.size());
  EXPECT_EQ((Bytes{0x23, 0x45, 0x13, 0x22, 0x07, 0x25, 0x0a, 0x00}),
            Bytes(cut.begin(), cut.begin() + 8));
  EXPECT_EQ((Bytes{0xff, 0xff, 0xb1}), Bytes(cut.begin() + 9, cut.end()));
  device.handleOutput({0x12, 0x04, 0x3f});
  device.sample(kThreeLights);
  const std::optional<Bytes> first = device.sample(kThreeLights);
  ASSERT_TRUE(first);
  EXPECT_EQ(0x3e, first->at(0));
  Bytes padded = kThreeExtended;
  padded.resize(18, 0xff);
  EXPECT_EQ(padded, Bytes(first->begin() + 4, first->end()));
}

TEST(PowerCycle, ForgetsAll) {
  Device device;
  for (const Bytes& output : handshake())
    device.handleOutput(output);
  device.handleOutput({0x10, 0x01});
  device.sample(kThreeLights);
  device.handleOutput({0x11, 0x10});
  device.powerCycle();
  EXPECT_EQ(0, device.leds());
  EXPECT_FALSE(device.rumble());
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
