#ifndef WIIMOTE_TRACKER_DRIVER_PROTOCOL_IR_CAMERA_H
#define WIIMOTE_TRACKER_DRIVER_PROTOCOL_IR_CAMERA_H

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
};

/// By name: wii_1 (least sensitive) .. wii_5 as in the console's settings, marcan, max.
std::optional<IrSensitivity> irSensitivity(const std::string& name);

/// All names that irSensitivity() knows.
std::vector<std::string> irSensitivityNames();

}  // namespace wiimote_tracker::protocol

#endif  // WIIMOTE_TRACKER_DRIVER_PROTOCOL_IR_CAMERA_H
