#include "player_leds.h"

#include <array>
#include <cctype>
#include <cstddef>

namespace wiimote_tracker::driver {

std::uint8_t playerLeds(const std::string& camera_name) {
  // By the number's remainder of 10. Always as few LEDs as possible, and among them LED 4.
  constexpr std::array<std::uint8_t, 10> kPatterns{0xf, 0x1, 0x2, 0x4, 0x8,
                                                   0x9, 0xa, 0xc, 0xd, 0xe};
  if (camera_name.empty() || std::isdigit(static_cast<unsigned char>(camera_name.back())) == 0)
    return kPatterns[1];
  return kPatterns[static_cast<std::size_t>(camera_name.back() - '0')];  // its last digit
}

}  // namespace wiimote_tracker::driver
