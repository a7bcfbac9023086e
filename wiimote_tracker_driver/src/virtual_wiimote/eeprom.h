#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// The EEPROM of a new Wii Remote: factory calibrations of camera and accelerometer, each with
/// checksum and a second copy; the rest is blank. Data that the host writes survive a change of
/// batteries.
class Eeprom {
 public:
  static constexpr std::size_t kSize = 0x1700;

  explicit Eeprom(const FactoryPoints& points);

  /// Whether the addresses address .. address + size - 1 exist.
  static bool contains(std::size_t address, std::size_t size) {
    return address < kSize && size <= kSize - address;
  }

  std::uint8_t& operator[](std::size_t address) { return bytes_[address]; }

  /// Output of the accelerometer's converter [0..1023] for a specific force [g], x, y, z. Uses the
  /// original factory calibration, whatever the host has written over it.
  static std::array<int, 3> convertAcceleration(const std::array<double, 3>& acceleration);

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace wiimote_tracker::virtual_wiimote
