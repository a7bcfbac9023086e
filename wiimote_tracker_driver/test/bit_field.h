#pragma once

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A number in a report, by the places of its bits on the wire, highest first: "8.5-4 6.7-0" is
/// bits 5 and 4 of byte 8, then all bits of byte 6. Tables of such texts are a second, independent
/// description of the reports; this class is their only interpreter.
class BitField {
 public:
  /// `first_byte` is added to every byte number.
  explicit BitField(const std::string& places, std::size_t first_byte = 0) {
    std::istringstream parts(places);
    std::size_t byte = 0;
    int high = 0;
    char separator = 0;
    while (parts >> byte >> separator >> high) {
      int low = high;
      if (parts.peek() == '-')
        parts >> separator >> low;
      for (int bit = high; bit >= low; --bit)
        bits_.push_back({first_byte + byte, static_cast<std::uint8_t>(1u << bit)});
    }
  }

  /// How many values the field can have.
  unsigned values() const { return 1u << bits_.size(); }

  unsigned read(const std::uint8_t* bytes) const {
    unsigned value = 0;
    for (const Bit& bit : bits_)
      value = value << 1 | ((bytes[bit.byte] & bit.mask) != 0 ? 1u : 0u);
    return value;
  }

  /// Leaves all other bits as they are.
  void write(std::uint8_t* bytes, unsigned value) const {
    for (std::size_t i = bits_.size(); i-- > 0; value >>= 1) {
      const Bit& bit = bits_[i];
      bytes[bit.byte] = static_cast<std::uint8_t>(
          (value & 1u) != 0 ? bytes[bit.byte] | bit.mask : bytes[bit.byte] & ~unsigned{bit.mask});
    }
  }

 private:
  struct Bit {
    std::size_t byte;
    std::uint8_t mask;
  };
  std::vector<Bit> bits_;
};

}  // namespace wiimote_tracker
