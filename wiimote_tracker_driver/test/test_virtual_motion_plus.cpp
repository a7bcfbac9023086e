// The MotionPlus built into a virtual RVL-CNT-01-TR, in raw bytes.
#include "virtual_remote_bytes.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::virtual_wiimote {
namespace {

const Bytes kActivate = write(0x04, {0xa6, 0x00, 0xfe}, {0x04});
const Bytes kDeactivate = write(0x04, {0xa4, 0x00, 0xf0}, {0x55});
const Bytes kReadExtension{0x17, 0x04, 0xa4, 0x00, 0xfa, 0x00, 0x06};
const Bytes kReadMotionPlus{0x17, 0x04, 0xa6, 0x00, 0xfa, 0x00, 0x06};

Device::Options remotePlus() {
  Device::Options options;
  options.motion_plus = true;
  return options;
}

Answers memory(const Bytes& payload) {
  Bytes report{0x21, 0x00, 0x00, 0x50, 0x00, 0xfa};
  report.insert(report.end(), payload.begin(), payload.end());
  report.resize(22, 0);
  return {report};
}

Answers noAnswer() {
  Bytes report{0x21, 0x00, 0x00, 0xf7, 0x00, 0xfa};
  report.resize(22, 0);
  return {report};
}

TEST(MotionPlus, SleepsAtAnAddressOfItsOwn) {
  Device device(remotePlus());
  EXPECT_EQ(memory({0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}), device.handleOutput(kReadMotionPlus));
  EXPECT_EQ(noAnswer(), device.handleOutput(kReadExtension));
  // What the kernel writes to every remote does not wake it.
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x00}}),
            device.handleOutput(write(0x04, {0xa6, 0x00, 0xf0}, {0x55})));
  EXPECT_EQ((Answers{{0x20, 0, 0, 0x00, 0, 0, 0xa0}}), device.handleOutput({0x15, 0x00}));
}

TEST(MotionPlus, ActiveOneIsAnExtensionToTheHost) {
  Device device(remotePlus());
  device.handleOutput({0x12, 0x04, 0x32});
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x00}, {0x20, 0, 0, 0x02, 0, 0, 0xa0}}),
            device.handleOutput(kActivate));
  EXPECT_FALSE(device.sample(Senses())) << "reports stop until a mode is set";
  EXPECT_EQ(memory({0x00, 0x00, 0xa4, 0x20, 0x04, 0x05}), device.handleOutput(kReadExtension));
  EXPECT_EQ(noAnswer(), device.handleOutput(kReadMotionPlus));
  device.handleOutput({0x12, 0x04, 0x32});
  EXPECT_EQ((Bytes{0x32, 0, 0, 0x00, 0x00, 0x00, 0x83, 0x82, 0x82, 0, 0}), device.sample(Senses()));
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x00}, {0x20, 0, 0, 0x00, 0, 0, 0xa0}}),
            device.handleOutput(kDeactivate));
  EXPECT_EQ(noAnswer(), device.handleOutput(kReadExtension));
}

TEST(MotionPlus, InfraredGoesOnWhileItIsActive) {
  Device device(remotePlus());
  device.handleOutput(kActivate);
  for (const Bytes& output : handshake())
    device.handleOutput(output);
  const Bytes report = *device.sample(lights({{100, 50, 2, 1}}));
  EXPECT_EQ((Bytes{100, 50, 2}), Bytes(report.begin() + 6, report.begin() + 9));
}

TEST(MotionPlus, SleepsAfterAPowerCycleAndIsNotInEveryRemote) {
  Device device(remotePlus());
  device.handleOutput(kActivate);
  device.powerCycle();
  EXPECT_EQ(1u, device.handleOutput(kReadMotionPlus).size());
  EXPECT_EQ(memory({0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}), device.handleOutput(kReadMotionPlus));
  Device without;
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x07}}), without.handleOutput(kActivate));
  EXPECT_EQ(noAnswer(), without.handleOutput(kReadMotionPlus));
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
