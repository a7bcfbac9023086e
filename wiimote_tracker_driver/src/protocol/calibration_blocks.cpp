#include "protocol/calibration_blocks.h"

#include "ir_position.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <numeric>

namespace wiimote_tracker::protocol {
namespace {

/// Whether the last byte is the sum of the others and 0x55.
template <std::size_t N>
bool checksumHolds(const std::array<std::uint8_t, N>& block) {
  return (std::accumulate(block.begin(), block.end() - 1, 0x55) & 0xff) == block.back();
}

}  // namespace

std::array<double, 2> IrCalibration::centre() const {
  std::array<double, 2> sum{};
  for (const auto& point : points) {
    sum[0] += point[0];
    sum[1] += point[1];
  }
  return {sum[0] / points.size(), sum[1] / points.size()};
}

std::optional<IrCalibration> decodeIrCalibrationBlock(
    const std::array<std::uint8_t, kIrCalibrationBlockSize>& block) {
  if (!checksumHolds(block))
    return std::nullopt;
  IrCalibration calibration;
  auto& points = calibration.points;
  for (std::size_t pair = 0; pair < 2; ++pair) {
    points[2 * pair] = firstOfPair(&block[5 * pair]);
    points[2 * pair + 1] = secondOfPair(&block[5 * pair]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][1] >= kSensorHeight)
      return std::nullopt;
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i] == points[j])
        return std::nullopt;
    }
  }
  return calibration;
}

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
