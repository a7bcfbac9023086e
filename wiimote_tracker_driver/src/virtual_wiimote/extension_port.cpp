#include "extension_port.h"

#include <algorithm>

namespace wiimote_tracker::virtual_wiimote {
namespace {

using SixBytes = std::array<std::uint8_t, 6>;

// Registers, and their values.
constexpr std::size_t kSetUp = 0xf0;
constexpr std::uint8_t kSetUpValue = 0x55;
constexpr std::size_t kEncryption = 0xfb;
constexpr std::uint8_t kOff = 0x00;
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

Nunchuk::Nunchuk() {
  // Any value except kOff means encrypted.
  registers_[kEncryption] = 0xff;
}

bool Nunchuk::plain() const {
  return registers_[kSetUp] == kSetUpValue && registers_[kEncryption] == kOff;
}

std::uint8_t Nunchuk::read(std::uint32_t address) const {
  if (!plain())
    return 0xff;
  const std::size_t at = address % 0x100;
  if (at < kNunchukAtRest.size())
    return kNunchukAtRest[at];
  return at >= kIdAddress ? kNunchukId[at - kIdAddress] : registers_[at];
}

ExtensionData Nunchuk::data() const {
  ExtensionData data{};
  for (std::size_t i = 0; i < kNunchukAtRest.size(); ++i)
    data[i] = read(static_cast<std::uint32_t>(i));
  return data;
}

MotionPlus::MotionPlus() {
  become(false);
}

void MotionPlus::write(std::uint32_t address, std::uint8_t value) {
  const std::size_t at = address % 0x100;
  registers_[at] = value;
  const bool activates =
      std::count(kActivateValues.begin(), kActivateValues.end(), value) > 0 && at == kActivate;
  if (!active_ && activates)
    become(true);
  else if (active_ && at == kSetUp && value == kSetUpValue)
    become(false);
}

void MotionPlus::become(bool active) {
  active_ = active;
  const auto& id = active ? kActiveId : kInactiveId;
  std::copy(id.begin(), id.end(), registers_.begin() + kIdAddress);
}

ExtensionData MotionPlus::data() const {
  ExtensionData data{};
  std::copy(kMotionPlusAtRest.begin(), kMotionPlusAtRest.end(), data.begin());
  return data;
}

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
