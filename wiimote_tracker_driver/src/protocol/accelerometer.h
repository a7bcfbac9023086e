#ifndef WIIMOTE_TRACKER_DRIVER_PROTOCOL_ACCELEROMETER_H
#define WIIMOTE_TRACKER_DRIVER_PROTOCOL_ACCELEROMETER_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace wiimote_tracker::protocol {

/// Where the factory calibration of the accelerometer is in the EEPROM, and its copy.
constexpr std::uint32_t kAccelerometerAddress = 0x0016;
constexpr std::uint32_t kAccelerometerCopyAddress = 0x0020;
constexpr std::size_t kAccelerometerBlockSize = 10;

/// Maps converter values to specific force. The default is that of a typical remote.
struct AccelerometerCalibration {
  std::array<int, 3> at_zero_g{0x200, 0x200, 0x200};  ///< [0..1023]
  std::array<int, 3> at_one_g{0x268, 0x268, 0x268};   ///< [0..1023], differs from at_zero_g

  /// Specific force [g]: +x left, +y rear, +z up of the remote lying with its buttons up.
  std::array<double, 3> toG(const std::array<int, 3>& raw) const;
};

/// The calibration of an EEPROM block. Nothing when its checksum is wrong or an axis has no scale.
std::optional<AccelerometerCalibration> decodeAccelerometerBlock(
    const std::array<std::uint8_t, kAccelerometerBlockSize>& block);

}  // namespace wiimote_tracker::protocol

#endif  // WIIMOTE_TRACKER_DRIVER_PROTOCOL_ACCELEROMETER_H
