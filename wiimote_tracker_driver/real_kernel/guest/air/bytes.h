#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace wiimote_tracker::real_kernel {

using Bytes = std::vector<std::uint8_t>;

/// A Bluetooth address as in HCI packets: the last byte of its text first.
using Address = std::array<std::uint8_t, 6>;

/// @throws std::invalid_argument unless the text is like "00:1f:32:00:00:01".
inline Address addressFrom(const std::string& text) {
  std::array<unsigned, 6> bytes{};
  if (std::sscanf(text.c_str(), "%2x:%2x:%2x:%2x:%2x:%2x", &bytes[5], &bytes[4], &bytes[3],
                  &bytes[2], &bytes[1], &bytes[0]) != 6)
    throw std::invalid_argument("not a Bluetooth address: '" + text + "'");
  Address address{};
  std::copy(bytes.begin(), bytes.end(), address.begin());
  return address;
}

/// Two bytes, the low one first.
inline Bytes le16(unsigned value) {
  return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
}

/// Two bytes, the high one first.
inline Bytes be16(unsigned value) {
  return {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
}

/// @throws std::out_of_range if there are no two bytes at `offset`.
inline unsigned le16At(const Bytes& bytes, std::size_t offset) {
  return bytes.at(offset) | static_cast<unsigned>(bytes.at(offset + 1)) << 8;
}
inline unsigned be16At(const Bytes& bytes, std::size_t offset) {
  return static_cast<unsigned>(bytes.at(offset)) << 8 | bytes.at(offset + 1);
}

/// All bytes from `offset`, at most `count`.
inline Bytes part(const Bytes& bytes, std::size_t offset, std::size_t count = SIZE_MAX) {
  const std::size_t begin = std::min(offset, bytes.size());
  const std::size_t end = begin + std::min(count, bytes.size() - begin);
  return Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
               bytes.begin() + static_cast<std::ptrdiff_t>(end));
}

/// The parts one after the other.
template <typename... Parts>
Bytes join(const Parts&... parts) {
  Bytes all;
  (all.insert(all.end(), parts.begin(), parts.end()), ...);
  return all;
}

}  // namespace wiimote_tracker::real_kernel
