#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_NUNCHUK_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_NUNCHUK_H

#include "data_report.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// The registers of a Nunchuk that nobody touches, from a400 00 on. Until the host has switched
/// its encryption off it gives nothing of use: ff. Its factory calibration is blank.
class Nunchuk {
 public:
  static bool hasRegister(std::uint32_t address) { return address >> 16 == 0xa4; }

  Nunchuk();

  void write(std::uint32_t address, std::uint8_t value) { registers_[address % 0x100] = value; }
  std::uint8_t read(std::uint32_t address) const;

  /// Its state as data reports carry it.
  ExtensionData data() const;

 private:
  bool plain() const;

  std::array<std::uint8_t, 0x100> registers_{};
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_NUNCHUK_H
