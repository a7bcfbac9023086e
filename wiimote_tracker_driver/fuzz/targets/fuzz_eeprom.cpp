#include "decisions.h"
#include "invariants.h"
#include "targets.h"

#include "protocol/calibration_blocks.h"

#include <cmath>
#include <numeric>

namespace wiimote_tracker::fuzz {
namespace {

/// The next bytes of the input as a block with a checksum. It is correct if the first byte is odd:
/// by chance it hardly ever would be.
template <std::size_t N>
std::array<std::uint8_t, N> block(Decisions& in) {
  const bool right = in.byte() % 2 == 1;
  std::array<std::uint8_t, N> result{};
  for (std::uint8_t& byte : result)
    byte = in.byte();
  if (right)
    result[N - 1] =
        static_cast<std::uint8_t>(std::accumulate(result.begin(), result.end() - 1, 0x55));
  return result;
}

}  // namespace

void fuzzEeprom(const std::uint8_t* data, std::size_t size) {
  Decisions in(data, size);
  const auto accelerometer =
      protocol::decodeAccelerometerBlock(block<protocol::kAccelerometerBlockSize>(in));
  if (accelerometer) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      require(accelerometer->at_zero_g[axis] != accelerometer->at_one_g[axis],
              "an axis has a scale");
    for (const double g : accelerometer->toG({0, 512, 1023}))
      require(std::isfinite(g) && std::abs(g) <= 1023.0, "every acceleration is a number");
  }
  const auto camera =
      protocol::decodeIrCalibrationBlock(block<protocol::kIrCalibrationBlockSize>(in));
  if (camera) {
    const auto centre = camera->centre();
    require(centre[0] >= 0.0 && centre[0] <= 1023.0, "x of the centre is on the sensor");
    require(centre[1] >= 0.0 && centre[1] <= 767.0, "y of the centre is on the sensor");
  }
}

}  // namespace wiimote_tracker::fuzz
