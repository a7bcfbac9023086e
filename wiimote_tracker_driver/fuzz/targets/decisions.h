#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::fuzz {

/// The input of a fuzz target as a sequence of decisions; 0 when it is used up.
class Decisions {
 public:
  Decisions(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}

  bool more() const { return next_ != end_; }

  std::uint8_t byte() { return more() ? *next_++ : std::uint8_t{0}; }

  protocol::IrFormat irFormat() {
    constexpr protocol::IrFormat kFormats[] = {
        protocol::IrFormat::kExtended, protocol::IrFormat::kBasic, protocol::IrFormat::kFull};
    return kFormats[byte() % 3];
  }

  protocol::IrSensitivity sensitivity() {
    const auto names = protocol::irSensitivityNames();
    return *protocol::irSensitivity(names[byte() % names.size()]);
  }

  /// A report of 0 to 22 bytes, its length first.
  protocol::Report report() {
    protocol::Report result;
    result.size = byte() % (protocol::Report::kCapacity + 1);
    for (std::size_t i = 0; i < result.size; ++i)
      result.bytes[i] = byte();
    return result;
  }

 private:
  const std::uint8_t* next_;
  const std::uint8_t* end_;
};

}  // namespace wiimote_tracker::fuzz
