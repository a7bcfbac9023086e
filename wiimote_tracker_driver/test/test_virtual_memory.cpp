// Registers and EEPROM of the virtual Wii Remote by their raw bytes, as documented for the real
// one.
#include "virtual_remote_bytes.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::virtual_wiimote {
namespace {

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

TEST(Eeprom, FactoryPointsCanBeSet) {
  Device::Options options;
  options.factory_points = {{{102, 77}, {102, 691}, {922, 691}, {922, 77}}};  // 10 % and 90 %
  Device device(options);
  EXPECT_EQ((Answers{{0x21, 0,    0,    0xa0, 0x00, 0x0b, 0x66, 0x4d, 0x08, 0x66, 0xb3,
                      0x9a, 0xb3, 0xb3, 0x9a, 0x4d, 0x10, 0,    0,    0,    0,    0}}),
            device.handleOutput({0x17, 0x00, 0x00, 0x00, 0x0b, 0x00, 0x0b}));
}

TEST(Eeprom, DrawnFactoryPointsLieAboutTheirCentre) {
  EXPECT_NE(factoryPoints(512, 384, 1), factoryPoints(512, 384, 2));
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const FactoryPoints points = factoryPoints(530, 370, seed);
    double x = 0.0;
    double y = 0.0;
    for (const auto& point : points) {
      x += point[0] / 4.0;
      y += point[1] / 4.0;
      EXPECT_TRUE(point[0] >= 0 && point[0] <= 1023 && point[1] >= 0 && point[1] <= 767);
    }
    EXPECT_NEAR(530.0, x, 8.5);
    EXPECT_NEAR(370.0, y, 8.5);
  }
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

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
