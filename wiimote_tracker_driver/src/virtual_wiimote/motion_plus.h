#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_MOTION_PLUS_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_MOTION_PLUS_H

#include "data_report.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// The gyroscope of a remote that lies still, as far as hosts look at it to find out what it is. It
/// sleeps at a600 00 until the host activates it; then it has the place of the extension, a400 00,
/// until that is set up anew.
class MotionPlus {
 public:
  MotionPlus();

  bool active() const { return active_; }
  bool hasRegister(std::uint32_t address) const { return address >> 16 == (active_ ? 0xa4 : 0xa6); }

  void write(std::uint32_t address, std::uint8_t value);
  std::uint8_t read(std::uint32_t address) const { return registers_[address % 0x100]; }

  /// Its state as data reports carry it while it is active.
  ExtensionData data() const;

 private:
  void become(bool active);

  bool active_ = false;
  std::array<std::uint8_t, 0x100> registers_{};
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_MOTION_PLUS_H
