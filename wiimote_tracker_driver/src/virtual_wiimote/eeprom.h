#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EEPROM_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EEPROM_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// The EEPROM of a new Wii Remote: factory calibration of the infrared camera and of the
/// accelerometer, each with its checksum and a second copy; the rest is blank. What the host
/// writes survives a change of batteries.
class Eeprom {
 public:
  static constexpr std::size_t kSize = 0x1700;

  explicit Eeprom(const FactoryPoints& points);

  /// Whether all of address .. address + size - 1 exists.
  static bool contains(std::size_t address, std::size_t size) {
    return address < kSize && size <= kSize - address;
  }

  std::uint8_t& operator[](std::size_t address) { return bytes_[address]; }

  /// What the accelerometer's converter says [0..1023] for a specific force [g], x, y, z. Follows
  /// from the factory calibration as it came, whatever the host has written over it.
  static std::array<int, 3> convertAcceleration(const std::array<double, 3>& acceleration);

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EEPROM_H
