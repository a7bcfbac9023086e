#include "motion_plus.h"

#include <algorithm>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kSetUp = 0xf0;
constexpr std::uint8_t kSetUpValue = 0x55;
constexpr std::size_t kActivate = 0xfe;
// On its own, or letting a Nunchuk or a Classic Controller through.
constexpr std::array<std::uint8_t, 3> kActivateValues{0x04, 0x05, 0x07};

constexpr std::size_t kIdAddress = 0xfa;
constexpr std::array<std::uint8_t, 6> kSleepingId{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05};
constexpr std::array<std::uint8_t, 6> kActiveId{0x00, 0x00, 0xa4, 0x20, 0x04, 0x05};
// Three rates of 14 bits, each 0x2000 at rest, their low bytes first; all in the fine range.
constexpr std::array<std::uint8_t, 6> kAtRest{0x00, 0x00, 0x00, 0x83, 0x82, 0x82};

}  // namespace

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
  const auto& id = active ? kActiveId : kSleepingId;
  std::copy(id.begin(), id.end(), registers_.begin() + kIdAddress);
}

ExtensionData MotionPlus::data() const {
  ExtensionData data{};
  std::copy(kAtRest.begin(), kAtRest.end(), data.begin());
  return data;
}

}  // namespace wiimote_tracker::virtual_wiimote
