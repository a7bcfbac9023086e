#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_LITTLE_ENDIAN_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_LITTLE_ENDIAN_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::recording {

/// The lowest `size` bytes of `value`, lowest first.
inline void appendLittleEndian(std::uint64_t value,
                               std::size_t size,
                               std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline std::uint64_t littleEndian(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
  return value;
}

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_LITTLE_ENDIAN_H
