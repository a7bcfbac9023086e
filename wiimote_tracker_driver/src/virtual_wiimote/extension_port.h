#pragma once

#include "data_report.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// The extension as the host sees it: a plugged-in Nunchuk, or the built-in MotionPlus as far as
/// hosts need to identify it, both at rest. A Nunchuk is at a400 00; it reads ff until the host has
/// switched the encryption off, and its factory calibration is blank. The MotionPlus is at a600 00
/// until it is activated. Then it is at a400 00 and hides the Nunchuk, until it is set up again.
class ExtensionPort {
 public:
  explicit ExtensionPort(bool has_motion_plus);

  void setNunchuk(bool plugged);
  bool nunchuk() const { return nunchuk_plugged_; }
  bool motionPlusActive() const { return motion_plus_active_; }
  bool empty() const { return !nunchuk_plugged_ && !motion_plus_active_; }

  /// Whether a device has this address on the bus.
  bool hasRegister(std::uint32_t address) const;
  /// @pre hasRegister(address)
  std::uint8_t read(std::uint32_t address) const;
  /// Ignored where no device has the address.
  void write(std::uint32_t address, std::uint8_t value);

  /// As in data reports; ff when empty.
  ExtensionData data() const;

 private:
  using Registers = std::array<std::uint8_t, 0x100>;

  bool isNunchuk(std::uint32_t address) const;
  bool isMotionPlus(std::uint32_t address) const;
  std::uint8_t readNunchuk(std::size_t at) const;
  void setMotionPlusActive(bool active);

  bool has_motion_plus_;
  bool nunchuk_plugged_ = false;
  bool motion_plus_active_ = false;
  Registers nunchuk_{}, motion_plus_{};
};

}  // namespace wiimote_tracker::virtual_wiimote
