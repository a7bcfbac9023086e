#ifndef WIIMOTE_TRACKER_DRIVER_PROTOCOL_IR_CALIBRATION_H
#define WIIMOTE_TRACKER_DRIVER_PROTOCOL_IR_CALIBRATION_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace wiimote_tracker::protocol {

/// Where the factory calibration of the infrared camera is in the EEPROM, and its copy.
constexpr std::uint32_t kIrCalibrationAddress = 0x0000;
constexpr std::uint32_t kIrCalibrationCopyAddress = 0x000b;
constexpr std::size_t kIrCalibrationBlockSize = 11;

/// Image points of four lights that the factory measured with this camera. The target's position is
/// unknown, so they are only a weak prior of the principal point.
struct IrCalibration {
  /// x, y in the sensor's axes [px]: x to the camera's right 0..1023, y UP 0..767.
  std::array<std::array<int, 2>, 4> points{};

  /// Mean of the points [px], in the same axes; nominally (512, 384). One remote that was read had
  /// (525.5, 353.8).
  std::array<double, 2> centre() const;
};

/// The calibration of an EEPROM block. Nothing when its checksum is wrong, or when the points do
/// not lie on the sensor, each at its own place, as in memory that was never written.
std::optional<IrCalibration> decodeIrCalibrationBlock(
    const std::array<std::uint8_t, kIrCalibrationBlockSize>& block);

}  // namespace wiimote_tracker::protocol

#endif  // WIIMOTE_TRACKER_DRIVER_PROTOCOL_IR_CALIBRATION_H
