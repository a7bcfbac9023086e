#ifndef WIIMOTE_TRACKER_DRIVER_PROTOCOL_CHECKSUM_H
#define WIIMOTE_TRACKER_DRIVER_PROTOCOL_CHECKSUM_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace wiimote_tracker::protocol {

/// Whether the last byte of a calibration block is the sum of the others and 0x55.
template <std::size_t N>
bool checksumHolds(const std::array<std::uint8_t, N>& block) {
  return (std::accumulate(block.begin(), block.end() - 1, 0x55) & 0xff) == block.back();
}

}  // namespace wiimote_tracker::protocol

#endif  // WIIMOTE_TRACKER_DRIVER_PROTOCOL_CHECKSUM_H
