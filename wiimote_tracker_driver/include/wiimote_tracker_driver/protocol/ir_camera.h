#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::protocol {

/// Register addresses of the infrared camera.
constexpr std::uint32_t kIrBlock1Register = 0xb00000;
constexpr std::uint32_t kIrBlock2Register = 0xb0001a;
constexpr std::uint32_t kIrControlRegister = 0xb00030;
constexpr std::uint32_t kIrModeRegister = 0xb00033;

/// Values of the control register.
constexpr std::uint8_t kIrControlSetup = 1;
constexpr std::uint8_t kIrControlRun = 8;

/// The two blocks of registers that together set the camera's sensitivity: largest and smallest
/// spot, gain and its limit.
struct IrSensitivity {
  std::array<std::uint8_t, 9> block1{};
  std::array<std::uint8_t, 2> block2{};

  friend bool operator==(const IrSensitivity& a, const IrSensitivity& b) {
    return a.block1 == b.block1 && a.block2 == b.block2;
  }
};

/// By name: wii_1 (lowest gain) .. wii_5 (highest) as in the console's settings; marcan and max, of
/// less gain than wii_2 and wii_4, keep the smallest spots.
std::optional<IrSensitivity> irSensitivity(const std::string& name);

/// All names that irSensitivity() knows.
std::vector<std::string> irSensitivityNames();

/// A name, or the bytes of a custom setting: nine of block 1 and two of block 2 in hexadecimal,
/// "07 00 00 71 01 00 72 00 20 / 1f 03"; the slash may be left out. @throws std::invalid_argument
/// with one sentence when it is neither, or when the gain limit (first byte of block 2) is not
/// below the gain (last byte of block 1): the camera then sees nothing.
IrSensitivity parseIrSensitivity(const std::string& text);

}  // namespace wiimote_tracker::protocol
