#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace wiimote_tracker::protocol {

/// One HID report as hidraw carries it: report id first, no 0xa1/0xa2 before it. Holds its bytes in
/// place, so that reports can be passed about without allocation.
struct Report {
  static constexpr std::size_t kCapacity = 22;

  std::array<std::uint8_t, kCapacity> bytes{};
  std::size_t size = 0;

  Report() = default;
  /// At most kCapacity bytes; more are cut off.
  Report(std::initializer_list<std::uint8_t> values) : Report(values.begin(), values.size()) {}
  Report(const std::uint8_t* data, std::size_t count) : size(std::min(count, kCapacity)) {
    std::copy_n(data, size, bytes.begin());
  }

  std::uint8_t id() const { return size > 0 ? bytes[0] : 0; }

  const std::uint8_t* begin() const { return bytes.data(); }
  const std::uint8_t* end() const { return bytes.data() + size; }

  friend bool operator==(const Report& a, const Report& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
};

}  // namespace wiimote_tracker::protocol
