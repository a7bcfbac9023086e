#include "protocol/accelerometer.h"

#include "checksum.h"

namespace wiimote_tracker::protocol {

std::array<double, 3> AccelerometerCalibration::toG(const std::array<int, 3>& raw) const {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = static_cast<double>(raw[i] - at_zero_g[i]) / (at_one_g[i] - at_zero_g[i]);
  return result;
}

std::optional<AccelerometerCalibration> decodeAccelerometerBlock(
    const std::array<std::uint8_t, kAccelerometerBlockSize>& block) {
  if (!checksumHolds(block))
    return std::nullopt;
  AccelerometerCalibration calibration;
  for (std::size_t i = 0; i < 3; ++i) {
    // The fourth byte of either half holds the low bits of x, y, z as 00xxyyzz.
    const int shift = 4 - 2 * static_cast<int>(i);
    calibration.at_zero_g[i] = block[i] << 2 | (block[3] >> shift & 3);
    calibration.at_one_g[i] = block[4 + i] << 2 | (block[7] >> shift & 3);
    if (calibration.at_zero_g[i] == calibration.at_one_g[i])
      return std::nullopt;
  }
  return calibration;
}

}  // namespace wiimote_tracker::protocol
