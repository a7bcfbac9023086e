#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <cstdint>

namespace wiimote_tracker::wiimote {

/// Settings of a remote.
struct Options {
  std::uint8_t leds = 0x1;  ///< Player LEDs 1..4 in bits 0..3, lit while connected.
  /// kBasic (report 0x37), kExtended (0x33), or kFull (0x3e and 0x3f in turn, at half the rate).
  protocol::IrFormat ir_format = protocol::IrFormat::kExtended;
  protocol::IrSensitivity sensitivity = *protocol::irSensitivity("wii_5");
  double reply_timeout = 0.5;     ///< [s, > 0] After this a request is repeated.
  double silence_timeout = 0.5;   ///< [s, > 0] Without an image, the watchdog acts.
  double status_interval = 60.0;  ///< [s, > 0] Between requests for the battery level.
};

}  // namespace wiimote_tracker::wiimote
