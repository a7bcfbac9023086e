#include "eeprom.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::virtual_wiimote {
namespace {

// Four points in the basic infrared format.
constexpr std::array<std::uint8_t, 10> kIrBlock{
    {0x88, 0x85, 0x8b, 0x8b, 0x8a, 0x97, 0x3f, 0x30, 0x8c, 0x39}};
// x, y, z at 0 g and their low bits; the same at 1 g; speaker volume and motor.
constexpr std::array<std::uint8_t, 9> kAccelerationBlock{
    {0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d, 0x9f, 0x02, 0x40}};
constexpr std::array<int, 3> kAtZero{0x84 << 2 | 3, 0x82 << 2, 0x86 << 2};
constexpr std::array<int, 3> kAtOne{0x9f << 2, 0x9d << 2, 0x9f << 2 | 2};

template <std::size_t N>
void store(std::vector<std::uint8_t>& memory,
           std::size_t address,
           const std::array<std::uint8_t, N>& block) {
  std::uint8_t checksum = 0x55;
  for (const std::uint8_t byte : block) {
    memory[address++] = byte;
    checksum = static_cast<std::uint8_t>(checksum + byte);
  }
  memory[address] = checksum;
}

}  // namespace

Eeprom::Eeprom() : bytes_(kSize, 0) {
  store(bytes_, 0x00, kIrBlock);
  store(bytes_, 0x0b, kIrBlock);
  store(bytes_, 0x16, kAccelerationBlock);
  store(bytes_, 0x20, kAccelerationBlock);
}

std::array<int, 3> Eeprom::convertAcceleration(const std::array<double, 3>& acceleration) {
  std::array<int, 3> raw{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = kAtZero[i] + acceleration[i] * (kAtOne[i] - kAtZero[i]);
    raw[i] = static_cast<int>(std::lround(std::clamp(value, 0.0, 1023.0)));
  }
  return raw;
}

}  // namespace wiimote_tracker::virtual_wiimote
