#include "protocol/ir_calibration.h"

#include "checksum.h"
#include "ir_position.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

namespace wiimote_tracker::protocol {

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

}  // namespace wiimote_tracker::protocol
