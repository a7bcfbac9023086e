// Bytes and their meaning, from hand-written vectors and from reports of real remotes.
#include "protocol/calibration_blocks.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace wiimote_tracker::protocol {
namespace {

void expectSpot(const IrSpot& spot, int x, int y, int size) {
  EXPECT_TRUE(spot.seen);
  EXPECT_EQ(x, spot.x);
  EXPECT_EQ(y, spot.y);
  EXPECT_EQ(size, spot.size);
}

/// Report 0x33 with these infrared bytes.
DataReport extended(const std::vector<std::uint8_t>& infrared) {
  Report report{0x33, 0x00, 0x00, 0x80, 0x80, 0x80};
  std::copy(infrared.begin(), infrared.end(), report.bytes.begin() + 6);
  report.size = 18;
  return *decodeDataReport(report);
}

/// Report 0x37 with these infrared bytes.
DataReport basic(const std::vector<std::uint8_t>& infrared) {
  Report report{0x37, 0x00, 0x00, 0x80, 0x80, 0x80};
  std::copy(infrared.begin(), infrared.end(), report.bytes.begin() + 6);
  report.size = 22;
  return *decodeDataReport(report);
}

TEST(Infrared, ExtendedGoldenVector) {
  const DataReport data =
      extended({0x23, 0x45, 0x13, 0xff, 0xff, 0xb1, 0x00, 0x80, 0x6f, 0xff, 0xff, 0xff});
  EXPECT_EQ(IrFormat::kExtended, data.ir_format);
  expectSpot(data.spots[0], 291, 69, 3);
  expectSpot(data.spots[1], 1023, 767, 1);
  expectSpot(data.spots[2], 512, 384, 15);
  EXPECT_FALSE(data.spots[3].seen);
}

TEST(Infrared, BasicGoldenVector) {
  const DataReport data = basic({0x23, 0x45, 0x1b, 0xff, 0xff, 0x00, 0x80, 0x6f, 0xff, 0xff});
  EXPECT_EQ(IrFormat::kBasic, data.ir_format);
  expectSpot(data.spots[0], 291, 69, 0);
  expectSpot(data.spots[1], 1023, 767, 0);
  expectSpot(data.spots[2], 512, 384, 0);
  EXPECT_FALSE(data.spots[3].seen);
}

TEST(Infrared, FullReport33) {
  // Buttons 20 60, accelerometer 80 80 80, third object absent.
  const std::optional<DataReport> data =
      decodeDataReport({0x33, 0x20, 0x60, 0x80, 0x80, 0x80, 0x55, 0xaa, 0x9d, 0xfe, 0x01, 0x35,
                        0xff, 0xff, 0xff, 0x23, 0x21, 0xdf});
  ASSERT_TRUE(data);
  EXPECT_EQ((std::array<int, 3>{0x201, 0x202, 0x202}), *data->acceleration);
  EXPECT_EQ(0, data->buttons);
  expectSpot(data->spots[0], 0x155, 0x2aa, 13);
  expectSpot(data->spots[1], 0x3fe, 0x001, 5);
  EXPECT_FALSE(data->spots[2].seen);
  // y = 0x321 = 801 is below the last line of the sensor, so this is not a spot.
  EXPECT_FALSE(data->spots[3].seen);
}

TEST(Infrared, ZerosAreASlotThatNeverHadALight) {
  EXPECT_FALSE(extended(std::vector<std::uint8_t>(12, 0)).spots[2].seen);
  EXPECT_FALSE(basic(std::vector<std::uint8_t>(10, 0)).spots[3].seen);
  // With a size it is a light in the corner.
  expectSpot(extended({0, 0, 0x04, 0, 0, 0, 0, 0, 0, 0, 0, 0}).spots[0], 0, 0, 4);
}

// Accelerometer X = 0x86, Y = 0x7f, Z = 0x9a, its bits scattered over both halves.
const Report kFirstHalf{0x3e, 0x20, 0x40, 0x86, 0x23, 0x45, 0x13, 35,   7,    37,   9,
                        0,    200,  0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
const Report kSecondHalf{0x3f, 0x40, 0x48, 0x7f, 0xff, 0xff, 0xb1, 126, 94, 127, 95,
                         0,    255,  0,    0,    0,    0,    0,    0,   0,  0,   0};

TEST(Infrared, FullGoldenVector) {
  const std::optional<DataReport> data = decodeInterleaved(kFirstHalf, kSecondHalf);
  ASSERT_TRUE(data);
  EXPECT_EQ(0x3e, data->id);
  EXPECT_EQ(IrFormat::kFull, data->ir_format);
  EXPECT_EQ(0x0008, data->buttons);
  EXPECT_EQ((std::array<int, 3>{0x86 << 2, 0x7f << 2, 0x9a << 2}), *data->acceleration);
  expectSpot(data->spots[0], 291, 69, 3);
  EXPECT_EQ(200, data->spots[0].intensity);
  EXPECT_EQ((std::array<int, 4>{35, 7, 37, 9}), data->spots[0].box);
  EXPECT_FALSE(data->spots[1].seen);
  expectSpot(data->spots[2], 1023, 767, 1);
  EXPECT_EQ(255, data->spots[2].intensity);
  EXPECT_EQ((std::array<int, 4>{126, 94, 127, 95}), data->spots[2].box);
  EXPECT_FALSE(data->spots[3].seen) << "zeros: never lit";
  EXPECT_TRUE(data->plausible);
  EXPECT_FALSE(decodeDataReport(kFirstHalf)) << "half an image is none";
}

TEST(Infrared, FullUnseenSlotHasNeitherSizeNorBoxNorIntensity) {
  Report half = kFirstHalf;
  half.bytes[6] = 0xd3;  // y = 837
  const std::optional<DataReport> data = decodeInterleaved(half, kSecondHalf);
  ASSERT_TRUE(data);
  EXPECT_FALSE(data->spots[0].seen);
  EXPECT_EQ(0, data->spots[0].size);
  EXPECT_EQ(0, data->spots[0].intensity);
  EXPECT_EQ((std::array<int, 4>{}), data->spots[0].box);
  EXPECT_FALSE(data->plausible);
}

TEST(Infrared, SlotsThatNoCameraInTheFormatSendsAreNotPlausible) {
  const std::vector<std::uint8_t> good{0x23, 0x45, 0x13, 0xff, 0xff, 0xff,
                                       0,    0,    0,    0xff, 0x10, 0x02};
  EXPECT_TRUE(extended(good).plausible);
  EXPECT_TRUE(extended(std::vector<std::uint8_t>(12, 0xff)).plausible);
  // y = 801, 769 (x = 0) and 1023 (x = 255).
  for (const std::vector<std::uint8_t>& slot : std::vector<std::vector<std::uint8_t>>{
           {0x23, 0x21, 0xdf}, {0x00, 0x01, 0xc0}, {0xff, 0xff, 0xcf}}) {
    std::vector<std::uint8_t> bad = good;
    std::copy(slot.begin(), slot.end(), bad.begin() + 3);
    EXPECT_FALSE(extended(bad).plausible);
    EXPECT_FALSE(extended(bad).spots[1].seen);
    EXPECT_TRUE(extended(bad).spots[0].seen);
  }
  EXPECT_TRUE(basic({0x23, 0x45, 0x1f, 0xff, 0xff, 0, 0, 0, 0, 0}).plausible);
  EXPECT_FALSE(basic({0x23, 0x45, 0x1c, 0xff, 0xff, 0, 0, 0, 0, 0}).plausible);
  Report half = kFirstHalf;
  half.bytes[9] = 0x80;
  EXPECT_FALSE(decodeInterleaved(half, kSecondHalf)->plausible);
}

TEST(Accelerometer, GoldenVector) {
  const std::optional<DataReport> data = decodeDataReport({0x31, 0x60, 0x60, 0x86, 0x7f, 0x9a});
  ASSERT_TRUE(data);
  EXPECT_EQ((std::array<int, 3>{0x21b, 0x1fe, 0x26a}), *data->acceleration);
  EXPECT_EQ(0, data->buttons);
  EXPECT_EQ(IrFormat::kNone, data->ir_format);
}

TEST(Accelerometer, CalibrationBlockOfARealRemote) {
  const std::optional<AccelerometerCalibration> calibration =
      decodeAccelerometerBlock({{0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d, 0x9f, 0x02, 0x40, 0x2e}});
  ASSERT_TRUE(calibration);
  EXPECT_EQ((std::array<int, 3>{531, 520, 536}), calibration->at_zero_g);
  EXPECT_EQ((std::array<int, 3>{636, 628, 638}), calibration->at_one_g);
  const std::array<double, 3> g = calibration->toG({531, 466, 638});
  EXPECT_DOUBLE_EQ(0.0, g[0]);
  EXPECT_DOUBLE_EQ(-0.5, g[1]);
  EXPECT_DOUBLE_EQ(1.0, g[2]);
}

TEST(Accelerometer, DamagedBlockIsRefused) {
  const std::array<std::uint8_t, 10> good{
      {0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d, 0x9f, 0x02, 0x40, 0x2e}};
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::array<std::uint8_t, 10> damaged = good;
    damaged[i] ^= 0x04;
    EXPECT_FALSE(decodeAccelerometerBlock(damaged)) << "byte " << i;
  }
  EXPECT_FALSE(decodeAccelerometerBlock({{0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}));
  // A correct checksum, but no difference between 0 g and 1 g: it would divide by zero.
  EXPECT_FALSE(decodeAccelerometerBlock({{0, 0, 0, 0, 0, 0, 0, 0, 0, 0x55}}));
}

const std::array<std::uint8_t, 11> kRealIrBlock{
    {0x88, 0x85, 0x8b, 0x8b, 0x8a, 0x97, 0x3f, 0x30, 0x8c, 0x39, 0xcd}};

TEST(IrCalibration, BlockOfARealRemote) {
  const std::optional<IrCalibration> calibration = decodeIrCalibrationBlock(kRealIrBlock);
  ASSERT_TRUE(calibration);
  EXPECT_EQ((std::array<int, 2>{136, 645}), calibration->points[0]);
  EXPECT_EQ((std::array<int, 2>{907, 650}), calibration->points[1]);
  EXPECT_EQ((std::array<int, 2>{919, 63}), calibration->points[2]);
  EXPECT_EQ((std::array<int, 2>{140, 57}), calibration->points[3]);
  EXPECT_DOUBLE_EQ(525.5, calibration->centre()[0]);
  EXPECT_DOUBLE_EQ(353.75, calibration->centre()[1]);
}

TEST(IrCalibration, DamagedBlockIsRefused) {
  for (std::size_t i = 0; i < kRealIrBlock.size(); ++i) {
    auto damaged = kRealIrBlock;
    damaged[i] ^= 0x04;
    EXPECT_FALSE(decodeIrCalibrationBlock(damaged)) << "byte " << i;
  }
  EXPECT_FALSE(decodeIrCalibrationBlock({{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}));
  EXPECT_FALSE(decodeIrCalibrationBlock({{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x55}})) << "blank";
  // A correct checksum, but the second point is at y = 778.
  EXPECT_FALSE(decodeIrCalibrationBlock(
      {{0x88, 0x85, 0x8f, 0x8b, 0x0a, 0x97, 0x3f, 0x30, 0x8c, 0x39, 0x51}}));
}

TEST(Status, RealLines) {
  std::optional<Status> status = decodeStatus({0x20, 0x00, 0x00, 0x02, 0x00, 0x00, 0x95});
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->extension);
  EXPECT_FALSE(status->battery_low);
  EXPECT_FALSE(status->camera);
  EXPECT_FALSE(status->speaker);
  EXPECT_EQ(0, status->leds);
  EXPECT_EQ(0x95, status->battery);

  status = decodeStatus({0x20, 0x00, 0x00, 0x42, 0x00, 0x00, 0x8f});
  ASSERT_TRUE(status);
  EXPECT_EQ(0x04, status->leds);  // LED 3
  EXPECT_EQ(0x8f, status->battery);

  status = decodeStatus({0x20, 0x00, 0x80, 0x19, 0x00, 0x00, 0x10});
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->camera);
  EXPECT_TRUE(status->battery_low);
  EXPECT_EQ(0x01, status->leds);
  EXPECT_EQ(0x0080, status->buttons);
}

TEST(Status, BatteryChargeStaysWithinItsRange) {
  EXPECT_EQ(0.0, batteryCharge(0));
  EXPECT_EQ(1.0, batteryCharge(0x8f));
  EXPECT_EQ(1.0, batteryCharge(0xff));
  EXPECT_NEAR(0.5, batteryCharge(53), 0.01);
}

TEST(Acknowledgement, RealLines) {
  std::optional<Acknowledgement> acknowledgement = decodeAcknowledgement({0x22, 0, 0, 0x16, 0x00});
  ASSERT_TRUE(acknowledgement);
  EXPECT_EQ(0x16, acknowledgement->report_id);
  EXPECT_EQ(0, acknowledgement->error);
  acknowledgement = decodeAcknowledgement({0x22, 0, 0, 0x12, 0x02});
  ASSERT_TRUE(acknowledgement);
  EXPECT_EQ(0x12, acknowledgement->report_id);
  EXPECT_EQ(2, acknowledgement->error);
}

TEST(Memory, RealLine) {
  const std::optional<MemoryPacket> packet =
      decodeMemoryPacket({0x21, 0x00, 0x00, 0xf0, 0x00, 0x40, 0xa0, 0x20, 0x10, 0x00, 0xff,
                          0xff, 0,    0,    0,    0,    0,    0,    0,    0,    0,    0});
  ASSERT_TRUE(packet);
  EXPECT_EQ(0, packet->error);
  EXPECT_EQ(16u, packet->size);
  EXPECT_EQ(0x0040, packet->address);
  EXPECT_EQ(0xa0, packet->data[0]);
  EXPECT_EQ(0xff, packet->data[5]);
}

TEST(Memory, ErrorsHaveNames) {
  EXPECT_STREQ("busy with another read", errorName(4));
  EXPECT_STREQ("no such address space", errorName(6));
  EXPECT_STREQ("no answer at this address", errorName(7));
  EXPECT_STREQ("address out of range", errorName(8));
  EXPECT_STREQ("unknown", errorName(0x5a));
}

TEST(Output, Bytes) {
  EXPECT_EQ((Report{0x10, 0x01}), setRumble(true));
  EXPECT_EQ((Report{0x10, 0x00}), setRumble(false));
  EXPECT_EQ((Report{0x11, 0x12}), setLeds(0x1));
  EXPECT_EQ((Report{0x11, 0x82}), setLeds(0x8));
  EXPECT_EQ((Report{0x12, 0x06, 0x33}), setReportMode(0x33, true));
  EXPECT_EQ((Report{0x12, 0x02, 0x30}), setReportMode(0x30, false));
  EXPECT_EQ((Report{0x13, 0x06}), setIrClock(true));
  EXPECT_EQ((Report{0x13, 0x02}), setIrClock(false));
  EXPECT_EQ((Report{0x1a, 0x06}), setIrLogic(true));
  EXPECT_EQ((Report{0x1a, 0x02}), setIrLogic(false));
  EXPECT_EQ((Report{0x15, 0x00}), requestStatus());
  EXPECT_EQ((Report{0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x0a}),
            readMemory(Space::kEeprom, 0x16, 10));
  EXPECT_EQ((Report{0x17, 0x04, 0xa6, 0x00, 0xfa, 0x01, 0x06}),
            readMemory(Space::kRegisters, 0xa600fa, 0x106));
  const std::uint8_t data[] = {0x63, 0x03};
  EXPECT_EQ((Report{0x16, 0x04, 0xb0, 0x00, 0x1a, 0x02, 0x63, 0x03, 0, 0, 0,
                    0,    0,    0,    0,    0,    0,    0,    0,    0, 0, 0}),
            writeMemory(Space::kRegisters, 0xb0001a, data, 2));
  EXPECT_THROW(writeMemory(Space::kEeprom, 0, data, 0), std::invalid_argument);
  EXPECT_THROW(writeMemory(Space::kEeprom, 0, data, 17), std::invalid_argument);
}

}  // namespace
}  // namespace wiimote_tracker::protocol
