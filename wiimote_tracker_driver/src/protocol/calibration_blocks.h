#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

/// The factory calibrations in the EEPROM: the address of each block, and that of its copy.
namespace wiimote_tracker::protocol {

constexpr std::uint32_t kIrCalibrationAddress = 0x0000;
constexpr std::uint32_t kIrCalibrationCopyAddress = 0x000b;
constexpr std::size_t kIrCalibrationBlockSize = 11;

constexpr std::uint32_t kAccelerometerAddress = 0x0016;
constexpr std::uint32_t kAccelerometerCopyAddress = 0x0020;
constexpr std::size_t kAccelerometerBlockSize = 10;

/// Image points of four lights that the factory measured with this camera. The target's position is
/// unknown, so they are only a weak prior of the principal point.
struct IrCalibration {
  /// x, y in the sensor's axes [px]: x to the camera's right 0..1023, y UP 0..767.
  std::array<std::array<int, 2>, 4> points{};

  /// Mean of the points [px], in the same axes; nominally (512, 384). One remote that was read had
  /// (525.5, 353.8).
  std::array<double, 2> centre() const;
};

/// Nothing when the checksum is wrong, or when the points do not lie on the sensor, each at its own
/// place, as in memory that was never written.
std::optional<IrCalibration> decodeIrCalibrationBlock(
    const std::array<std::uint8_t, kIrCalibrationBlockSize>& block);

/// Maps the accelerometer's converter values to specific force. The default is that of a typical
/// remote.
struct AccelerometerCalibration {
  std::array<int, 3> at_zero_g{0x200, 0x200, 0x200};  ///< [0..1023]
  std::array<int, 3> at_one_g{0x268, 0x268, 0x268};   ///< [0..1023], differs from at_zero_g

  /// Specific force [g]: +x left, +y rear, +z up of the remote lying with its buttons up.
  std::array<double, 3> toG(const std::array<int, 3>& raw) const;
};

/// Nothing when the checksum is wrong or an axis has no scale.
std::optional<AccelerometerCalibration> decodeAccelerometerBlock(
    const std::array<std::uint8_t, kAccelerometerBlockSize>& block);

}  // namespace wiimote_tracker::protocol
