#include "eeprom.h"

#include "ir_camera.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace wiimote_tracker::virtual_wiimote {
namespace {

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

FactoryPoints factoryPoints(double centre_x, double centre_y, std::uint32_t seed) {
  constexpr double kHalfWidth = 0.4 * 1024.0;
  constexpr double kHalfHeight = 0.4 * 768.0;
  constexpr int kScatter = 8;  // [px]; the one real block is not an exact rectangle either
  std::mt19937 random(seed);
  const auto near = [&](double value, int limit) {
    const int offset = static_cast<int>(random() % (2 * kScatter + 1)) - kScatter;
    return std::clamp(static_cast<int>(std::lround(value)) + offset, 0, limit - 1);
  };
  // In the order of the real block: clockwise from the top left.
  constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
  FactoryPoints points{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i][0] = near(centre_x + kCorners[i][0] * kHalfWidth, 1024);
    points[i][1] = near(centre_y + kCorners[i][1] * kHalfHeight, 768);
  }
  return points;
}

Eeprom::Eeprom(const FactoryPoints& points) : bytes_(kSize, 0) {
  store(bytes_, 0x00, basicFormat(points));
  store(bytes_, 0x0b, basicFormat(points));
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
