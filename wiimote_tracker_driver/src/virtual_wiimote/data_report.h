#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// The lowest eight bits of a value.
constexpr std::uint8_t byte(int value) {
  return static_cast<std::uint8_t>(value);
}

/// Bytes of an extension, as many as the longest report carries.
using ExtensionData = std::array<std::uint8_t, 21>;

/// The contents of data reports at one instant.
struct Sample {
  std::uint16_t buttons = 0;
  std::array<int, 3> acceleration{};  ///< As converted [0..1023].
  std::array<std::uint8_t, 36> infrared{};
  ExtensionData extension{};
};

/// The two halves of a sample that is too long for one report.
constexpr std::uint8_t kFirstHalf = 0x3e;
constexpr std::uint8_t kSecondHalf = 0x3f;

/// A report starts with its id and, except for 0x3d, the buttons.
Bytes beginReport(std::uint8_t id, std::uint16_t buttons);

bool isDataReport(std::uint8_t id);

/// The data report of that id, which must be one.
Bytes dataReport(std::uint8_t id, const Sample& sample);

}  // namespace wiimote_tracker::virtual_wiimote
