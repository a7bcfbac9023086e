// Sensitivities of the infrared camera: their bytes, names and texts.
#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::protocol {
namespace {

TEST(Sensitivity, Blocks) {
  // As published: the console's five levels, and two that users have found.
  const std::vector<std::pair<std::string, IrSensitivity>> published{
      {"wii_1", {{{0x02, 0, 0, 0x71, 0x01, 0, 0x64, 0, 0xfe}}, {{0xfd, 0x05}}}},
      {"wii_2", {{{0x02, 0, 0, 0x71, 0x01, 0, 0x96, 0, 0xb4}}, {{0xb3, 0x04}}}},
      {"wii_3", {{{0x02, 0, 0, 0x71, 0x01, 0, 0xaa, 0, 0x64}}, {{0x63, 0x03}}}},
      {"wii_4", {{{0x02, 0, 0, 0x71, 0x01, 0, 0xc8, 0, 0x36}}, {{0x35, 0x03}}}},
      {"wii_5", {{{0x07, 0, 0, 0x71, 0x01, 0, 0x72, 0, 0x20}}, {{0x1f, 0x03}}}},
      {"marcan", {{{0, 0, 0, 0, 0, 0, 0x90, 0, 0xc0}}, {{0x40, 0}}}},
      {"max", {{{0, 0, 0, 0, 0, 0, 0x90, 0, 0x41}}, {{0x40, 0}}}}};
  std::vector<std::string> names;
  for (const auto& [name, sensitivity] : published) {
    EXPECT_TRUE(irSensitivity(name) == sensitivity) << name;
    names.push_back(name);
  }
  EXPECT_EQ(names, irSensitivityNames());
  EXPECT_FALSE(irSensitivity("wii_6"));
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
