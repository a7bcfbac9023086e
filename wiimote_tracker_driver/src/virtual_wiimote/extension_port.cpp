#include "extension_port.h"

namespace wiimote_tracker::virtual_wiimote {

void ExtensionPort::setNunchuk(bool plugged) {
  nunchuk_plugged_ = plugged;
  nunchuk_ = Nunchuk();
}

bool ExtensionPort::nunchukHas(std::uint32_t address) const {
  return nunchuk_plugged_ && !motion_plus_.active() && Nunchuk::hasRegister(address);
}

bool ExtensionPort::motionPlusHas(std::uint32_t address) const {
  return has_motion_plus_ && motion_plus_.hasRegister(address);
}

bool ExtensionPort::hasRegister(std::uint32_t address) const {
  return nunchukHas(address) || motionPlusHas(address);
}

std::uint8_t ExtensionPort::read(std::uint32_t address) const {
  return motionPlusHas(address) ? motion_plus_.read(address) : nunchuk_.read(address);
}

void ExtensionPort::write(std::uint32_t address, std::uint8_t value) {
  if (motionPlusHas(address))
    motion_plus_.write(address, value);
  else if (nunchukHas(address))
    nunchuk_.write(address, value);
}

ExtensionData ExtensionPort::data() const {
  if (motion_plus_.active())
    return motion_plus_.data();
  if (nunchuk_plugged_)
    return nunchuk_.data();
  ExtensionData none;
  none.fill(0xff);
  return none;
}

}  // namespace wiimote_tracker::virtual_wiimote
