#include "nunchuk.h"

#include <algorithm>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kEncryption1 = 0xf0;
constexpr std::size_t kEncryption2 = 0xfb;
constexpr std::uint8_t kOff1 = 0x55;
constexpr std::uint8_t kOff2 = 0x00;

constexpr std::size_t kIdAddress = 0xfa;
constexpr std::array<std::uint8_t, 6> kId{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00};
// Stick x and y in the middle; x, y at 0 g and z at 1 g; no button pressed.
constexpr std::array<std::uint8_t, 6> kAtRest{0x80, 0x80, 0x80, 0x80, 0xb3, 0x03};

}  // namespace

Nunchuk::Nunchuk() {
  // Encrypted: any value that is not the one for off.
  registers_[kEncryption2] = 0xff;
}

bool Nunchuk::plain() const {
  return registers_[kEncryption1] == kOff1 && registers_[kEncryption2] == kOff2;
}

std::uint8_t Nunchuk::read(std::uint32_t address) const {
  if (!plain())
    return 0xff;
  const std::size_t at = address % 0x100;
  if (at < kAtRest.size())
    return kAtRest[at];
  return at >= kIdAddress ? kId[at - kIdAddress] : registers_[at];
}

ExtensionData Nunchuk::data() const {
  ExtensionData data{};
  for (std::size_t i = 0; i < kAtRest.size(); ++i)
    data[i] = read(static_cast<std::uint32_t>(i));
  return data;
}

}  // namespace wiimote_tracker::virtual_wiimote
