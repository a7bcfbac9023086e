#pragma once

#include <array>
#include <cstdint>

/// x and y [0..1023] as the camera packs them: eight bits each in bytes of their own, the highest
/// two together with those of a neighbour or with a size.
namespace wiimote_tracker::protocol {

/// Three bytes: x, y, yyxx.... (high bits first). Also the first of a pair of the basic format.
inline std::array<int, 2> firstOfPair(const std::uint8_t* in) {
  return {in[0] | (in[2] << 4 & 0x300), in[1] | (in[2] << 2 & 0x300)};
}

/// The second of a pair of the basic format, five bytes: ..., ..., ....yyxx, x, y.
inline std::array<int, 2> secondOfPair(const std::uint8_t* in) {
  return {in[3] | (in[2] << 8 & 0x300), in[4] | (in[2] << 6 & 0x300)};
}

}  // namespace wiimote_tracker::protocol
