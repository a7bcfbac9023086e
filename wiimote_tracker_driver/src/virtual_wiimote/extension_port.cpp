#include "extension_port.h"

#include <algorithm>

namespace wiimote_tracker::virtual_wiimote {
namespace {

using SixBytes = std::array<std::uint8_t, 6>;

constexpr std::uint32_t kExtensionPage = 0xa4;  // address >> 16
constexpr std::uint32_t kMotionPlusPage = 0xa6;

// Registers, and their values.
constexpr std::size_t kSetUp = 0xf0;
constexpr std::uint8_t kSetUpValue = 0x55;
constexpr std::size_t kEncryption = 0xfb;
constexpr std::uint8_t kPlain = 0x00;  // any other value means encrypted
constexpr std::size_t kActivate = 0xfe;
// Alone, or with pass-through of a Nunchuk or Classic Controller.
constexpr std::array<std::uint8_t, 3> kActivateValues{0x04, 0x05, 0x07};
constexpr std::size_t kIdAddress = 0xfa;
constexpr SixBytes kNunchukId{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00};
constexpr SixBytes kInactiveId{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05};
constexpr SixBytes kActiveId{0x00, 0x00, 0xa4, 0x20, 0x04, 0x05};

// Stick centred; x, y at 0 g and z at 1 g; no button pressed.
constexpr SixBytes kNunchukAtRest{0x80, 0x80, 0x80, 0x80, 0xb3, 0x03};
// Three rates of 14 bits, each 0x2000 at rest, low bytes first; all in slow mode.
constexpr SixBytes kMotionPlusAtRest{0x00, 0x00, 0x00, 0x83, 0x82, 0x82};

}  // namespace

ExtensionPort::ExtensionPort(bool has_motion_plus) : has_motion_plus_(has_motion_plus) {
  setNunchuk(false);
  setMotionPlusActive(false);
}

void ExtensionPort::setNunchuk(bool plugged) {
  nunchuk_plugged_ = plugged;
  nunchuk_.fill(0);
  nunchuk_[kEncryption] = 0xff;
}

void ExtensionPort::setMotionPlusActive(bool active) {
  motion_plus_active_ = active;
  const SixBytes& id = active ? kActiveId : kInactiveId;
  std::copy(id.begin(), id.end(), motion_plus_.begin() + kIdAddress);
}

bool ExtensionPort::isNunchuk(std::uint32_t address) const {
  return nunchuk_plugged_ && !motion_plus_active_ && address >> 16 == kExtensionPage;
}

bool ExtensionPort::isMotionPlus(std::uint32_t address) const {
  return has_motion_plus_ &&
         address >> 16 == (motion_plus_active_ ? kExtensionPage : kMotionPlusPage);
}

bool ExtensionPort::hasRegister(std::uint32_t address) const {
  return isNunchuk(address) || isMotionPlus(address);
}

std::uint8_t ExtensionPort::read(std::uint32_t address) const {
  const std::size_t at = address % 0x100;
  return isMotionPlus(address) ? motion_plus_[at] : readNunchuk(at);
}

std::uint8_t ExtensionPort::readNunchuk(std::size_t at) const {
  if (nunchuk_[kSetUp] != kSetUpValue || nunchuk_[kEncryption] != kPlain)
    return 0xff;
  if (at < kNunchukAtRest.size())
    return kNunchukAtRest[at];
  return at >= kIdAddress ? kNunchukId[at - kIdAddress] : nunchuk_[at];
}

void ExtensionPort::write(std::uint32_t address, std::uint8_t value) {
  const std::size_t at = address % 0x100;
  if (isNunchuk(address))
    nunchuk_[at] = value;
  if (!isMotionPlus(address))
    return;
  motion_plus_[at] = value;
  const bool activates =
      at == kActivate && std::count(kActivateValues.begin(), kActivateValues.end(), value) > 0;
  if (!motion_plus_active_ && activates)
    setMotionPlusActive(true);
  else if (motion_plus_active_ && at == kSetUp && value == kSetUpValue)
    setMotionPlusActive(false);
}

ExtensionData ExtensionPort::data() const {
  ExtensionData data{};
  if (empty()) {
    data.fill(0xff);
    return data;
  }
  for (std::size_t i = 0; i < kNunchukAtRest.size(); ++i)
    data[i] = motion_plus_active_ ? kMotionPlusAtRest[i] : readNunchuk(i);
  return data;
}

}  // namespace wiimote_tracker::virtual_wiimote
