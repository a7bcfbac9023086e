#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_OPTIONS_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_OPTIONS_H

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <cstdint>

namespace wiimote_tracker::wiimote {

/// Settings of a session.
struct SessionOptions {
  std::uint8_t leds = 0x1;  ///< Player LEDs 1..4 in bits 0..3, lit while connected.
  /// kBasic (report 0x37), kExtended (0x33), or kFull (0x3e and 0x3f in turn, at half the rate).
  protocol::IrFormat ir_format = protocol::IrFormat::kExtended;
  protocol::IrSensitivity sensitivity = *protocol::irSensitivity("wii_5");
  double reply_timeout = 0.5;    ///< [s, > 0] After this a request is repeated.
  int attempts = 5;              ///< [>= 1] After so many the remote is given up.
  double silence_timeout = 0.5;  ///< [s, > 0] Without an image, the watchdog acts.
  double dark_check = 0.5;       ///< [s, > 0] Without a light, the camera is checked.
  /// [s, > 0] Between two checks of the camera, each of a third of its registers. A check costs one
  /// data report: one image in 200 by default.
  double check_interval = 2.0;
  double status_interval = 60.0;  ///< [s, > 0] Between requests for the battery level.
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_OPTIONS_H
