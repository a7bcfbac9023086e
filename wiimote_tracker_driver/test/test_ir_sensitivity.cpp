// Sensitivities of the infrared camera: their bytes, names and texts.
#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace wiimote_tracker::protocol {
namespace {

TEST(Sensitivity, Blocks) {
  const std::optional<IrSensitivity> wii3 = irSensitivity("wii_3");
  ASSERT_TRUE(wii3);
  EXPECT_EQ((std::array<std::uint8_t, 9>{{0x02, 0, 0, 0x71, 0x01, 0, 0xaa, 0, 0x64}}),
            wii3->block1);
  EXPECT_EQ((std::array<std::uint8_t, 2>{{0x63, 0x03}}), wii3->block2);
  EXPECT_FALSE(irSensitivity("wii_6"));
  EXPECT_EQ(7u, irSensitivityNames().size());
}

TEST(Sensitivity, TextIsANameOrElevenBytes) {
  EXPECT_EQ(*irSensitivity("wii_2"), parseIrSensitivity("wii_2"));
  const IrSensitivity wii5 = *irSensitivity("wii_5");
  EXPECT_EQ(wii5, parseIrSensitivity("07 00 00 71 01 00 72 00 20 / 1f 03"));
  EXPECT_EQ(wii5, parseIrSensitivity("  7 0 0 71 1 0 72 0 20 1F 3"));
  EXPECT_FALSE(wii5 == parseIrSensitivity("07 00 00 71 01 00 72 00 21 1f 03"));
}

TEST(Sensitivity, OtherTextIsRefusedWithTheReason) {
  const auto reason = [](const std::string& text) -> std::string {
    try {
      parseIrSensitivity(text);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  for (const char* text :
       {"", "wii_6", "WII_2", "07 00 00 71 01 00 72 00 20 1f",
        "07 00 00 71 01 00 72 00 20 1f 03 00", "07 00 00 71 01 00 72 00 / 20 1f 03",
        "07 00 00 71 01 00 72 00 20 1f g3", "07 00 00 71 01 00 72 00 20 1f 003",
        "0700007101007200201f03", "-7 0 0 0 0 0 1 0 2 1 0"}) {
    EXPECT_NE(std::string::npos, reason(text).find("must be one of wii_1, ")) << text;
  }
  EXPECT_NE(std::string::npos,
            reason("07 00 00 71 01 00 72 00 20 / 20 03").find("the gain limit, must be less"));
}

TEST(Sensitivity, GainLimitIsBelowGain) {
  for (const std::string& name : irSensitivityNames()) {
    const std::optional<IrSensitivity> sensitivity = irSensitivity(name);
    ASSERT_TRUE(sensitivity) << name;
    EXPECT_LT(sensitivity->block2[0], sensitivity->block1[8]) << name;
  }
}

}  // namespace
}  // namespace wiimote_tracker::protocol
