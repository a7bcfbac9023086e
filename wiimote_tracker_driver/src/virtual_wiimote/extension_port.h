#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EXTENSION_PORT_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EXTENSION_PORT_H

#include "data_report.h"

#include <array>
#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// A Nunchuk at rest, with registers from a400 00 on. Reads give ff until the host has switched the
/// encryption off. Its factory calibration is blank.
class Nunchuk {
 public:
  static bool hasRegister(std::uint32_t address) { return address >> 16 == 0xa4; }

  Nunchuk();

  void write(std::uint32_t address, std::uint8_t value) { registers_[address % 0x100] = value; }
  std::uint8_t read(std::uint32_t address) const;

  /// As in data reports.
  ExtensionData data() const;

 private:
  bool plain() const;

  std::array<std::uint8_t, 0x100> registers_{};
};

/// The built-in MotionPlus of a remote at rest, as far as hosts need to identify it. It is at a600
/// 00 until activated, then at a400 00 like an extension, until that is set up again.
class MotionPlus {
 public:
  MotionPlus();

  bool active() const { return active_; }
  bool hasRegister(std::uint32_t address) const { return address >> 16 == (active_ ? 0xa4 : 0xa6); }

  void write(std::uint32_t address, std::uint8_t value);
  std::uint8_t read(std::uint32_t address) const { return registers_[address % 0x100]; }

  /// As in data reports while it is active.
  ExtensionData data() const;

 private:
  void become(bool active);

  bool active_ = false;
  std::array<std::uint8_t, 0x100> registers_{};
};

/// The extension as the host sees it: a plugged-in Nunchuk, or the built-in MotionPlus, which hides
/// the Nunchuk while it is active.
class ExtensionPort {
 public:
  explicit ExtensionPort(bool has_motion_plus) : has_motion_plus_(has_motion_plus) {}

  void setNunchuk(bool plugged);
  bool nunchuk() const { return nunchuk_plugged_; }
  bool motionPlusActive() const { return motion_plus_.active(); }
  bool empty() const { return !nunchuk_plugged_ && !motion_plus_.active(); }

  /// Whether a device has this address on the bus.
  bool hasRegister(std::uint32_t address) const;
  /// @pre hasRegister(address)
  std::uint8_t read(std::uint32_t address) const;
  /// Ignored where no device has the address.
  void write(std::uint32_t address, std::uint8_t value);

  /// As in data reports; ff when empty.
  ExtensionData data() const;

 private:
  bool nunchukHas(std::uint32_t address) const;
  bool motionPlusHas(std::uint32_t address) const;

  bool has_motion_plus_;
  bool nunchuk_plugged_ = false;
  Nunchuk nunchuk_;
  MotionPlus motion_plus_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EXTENSION_PORT_H
