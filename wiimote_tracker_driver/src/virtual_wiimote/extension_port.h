#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EXTENSION_PORT_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_EXTENSION_PORT_H

#include "motion_plus.h"
#include "nunchuk.h"

#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// What the host takes for the extension: a Nunchuk that may be plugged in, or a built-in
/// MotionPlus, which hides it while it is active.
class ExtensionPort {
 public:
  explicit ExtensionPort(bool has_motion_plus) : has_motion_plus_(has_motion_plus) {}

  void setNunchuk(bool plugged);
  bool nunchuk() const { return nunchuk_plugged_; }
  bool motionPlusActive() const { return motion_plus_.active(); }
  bool empty() const { return !nunchuk_plugged_ && !motion_plus_.active(); }

  /// Whether somebody answers at this address of the bus.
  bool hasRegister(std::uint32_t address) const;
  /// @pre hasRegister(address)
  std::uint8_t read(std::uint32_t address) const;
  /// Goes nowhere where nobody answers.
  void write(std::uint32_t address, std::uint8_t value);

  /// As data reports carry it; ff when empty.
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
