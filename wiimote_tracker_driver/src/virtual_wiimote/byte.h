#ifndef WIIMOTE_TRACKER_DRIVER_SRC_VIRTUAL_WIIMOTE_BYTE_H
#define WIIMOTE_TRACKER_DRIVER_SRC_VIRTUAL_WIIMOTE_BYTE_H

#include <cstdint>

namespace wiimote_tracker::virtual_wiimote {

/// The lowest eight bits of a value.
constexpr std::uint8_t byte(int value) {
  return static_cast<std::uint8_t>(value);
}

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_SRC_VIRTUAL_WIIMOTE_BYTE_H
