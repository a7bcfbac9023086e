// A Nunchuk at the virtual Wii Remote, in raw bytes.
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::virtual_wiimote {
namespace {

using Answers = std::vector<Bytes>;

const Bytes kReadId{0x17, 0x04, 0xa4, 0x00, 0xfa, 0x00, 0x06};

Bytes write(std::uint8_t address, std::uint8_t value) {
  Bytes report{0x16, 0x04, 0xa4, 0x00, address, 0x01, value};
  report.resize(22, 0);
  return report;
}

const Bytes kId{0x21, 0x00, 0x00, 0x50, 0x00, 0xfa, 0x00, 0x00, 0xa4, 0x20, 0x00,
                0x00, 0,    0,    0,    0,    0,    0,    0,    0,    0,    0};
const Bytes kEncryptedId{0x21, 0x00, 0x00, 0x50, 0x00, 0xfa, 0xff, 0xff, 0xff, 0xff, 0xff,
                         0xff, 0,    0,    0,    0,    0,    0,    0,    0,    0,    0};

TEST(Nunchuk, StatusReportsPlugAndUnplug) {
  Device device;
  EXPECT_EQ((Bytes{0x20, 0x00, 0x00, 0x02, 0x00, 0x00, 0xa0}), device.setNunchuk(true));
  EXPECT_EQ(std::nullopt, device.setNunchuk(true));
  EXPECT_EQ((Answers{{0x20, 0x00, 0x00, 0x02, 0x00, 0x00, 0xa0}}),
            device.handleOutput({0x15, 0x00}));
  EXPECT_EQ((Bytes{0x20, 0x00, 0x00, 0x00, 0x00, 0x00, 0xa0}), device.setNunchuk(false));
  EXPECT_EQ(std::nullopt, device.setNunchuk(false));
}

TEST(Nunchuk, ReportingStopsUntilAModeIsSet) {
  for (const bool plugged : {true, false}) {
    Device device;
    device.setNunchuk(!plugged);
    device.handleOutput({0x12, 0x04, 0x31});
    ASSERT_TRUE(device.sample(Senses()));
    device.setNunchuk(plugged);
    EXPECT_FALSE(device.sample(Senses()));
    device.handleOutput({0x15, 0x00});
    EXPECT_FALSE(device.sample(Senses())) << "a status request does not start it again";
    device.handleOutput({0x12, 0x04, 0x31});
    EXPECT_TRUE(device.sample(Senses()));
  }
}

TEST(Nunchuk, AnswersOnTheBusOnlyWhilePlugged) {
  Device device;
  const Answers no_answer{
      {0x21, 0x00, 0x00, 0xf7, 0x00, 0xfa, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
  EXPECT_EQ(no_answer, device.handleOutput(kReadId));
  EXPECT_EQ((Answers{{0x22, 0x00, 0x00, 0x16, 0x07}}), device.handleOutput(write(0xf0, 0x55)));
  device.setNunchuk(true);
  EXPECT_EQ((Answers{{0x22, 0x00, 0x00, 0x16, 0x00}}), device.handleOutput(write(0xf0, 0x55)));
  device.setNunchuk(false);
  EXPECT_EQ(no_answer, device.handleOutput(kReadId));
}

TEST(Nunchuk, IdentifiesItselfWithoutEncryption) {
  Device device;
  device.setNunchuk(true);
  EXPECT_EQ(Answers{kEncryptedId}, device.handleOutput(kReadId));
  device.handleOutput(write(0xf0, 0x55));
  device.handleOutput(write(0xfb, 0x00));
  EXPECT_EQ(Answers{kId}, device.handleOutput(kReadId));
  device.powerCycle();
  EXPECT_EQ(Answers{kEncryptedId}, device.handleOutput(kReadId));
}

TEST(Nunchuk, ItsStateTravelsInDataReports) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x32});
  EXPECT_EQ((Bytes{0x32, 0, 0, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}),
            device.sample(Senses()));
  device.setNunchuk(true);
  device.handleOutput(write(0xf0, 0x55));
  device.handleOutput(write(0xfb, 0x00));
  device.handleOutput({0x12, 0x04, 0x32});
  EXPECT_EQ((Bytes{0x32, 0, 0, 0x80, 0x80, 0x80, 0x80, 0xb3, 0x03, 0, 0}), device.sample(Senses()));
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
