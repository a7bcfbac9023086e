#pragma once

#include "wiimote/wiimote.h"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

namespace wiimote_tracker::driver {

/// Requests of callbacks, kept until the thread that talks to the remote applies them. Thread-safe.
class RemoteControl {
 public:
  /// `leds`: lit now. `rumble_max`: time after which the motor stops [s], because it shakes the
  /// camera.
  RemoteControl(std::uint8_t leds, double rumble_max);

  void setSensitivity(const protocol::IrSensitivity& sensitivity);

  /// Player LEDs 1..4 in bits 0..3; only those in `mask` are changed.
  void setLeds(std::uint8_t leds, std::uint8_t mask = 0xf);

  void setRumble(bool on);

  /// Applies the requests to the remote; always in one thread. `now` [s]: any clock that never goes
  /// back.
  void apply(wiimote::Wiimote& wiimote, double now);

 private:
  const double rumble_max_;
  std::atomic<bool> changed_{false};
  std::mutex mutex_;  // guards the members below, but for rumble_end_
  std::optional<protocol::IrSensitivity> sensitivity_;
  std::uint8_t leds_;
  bool leds_changed_ = false;
  std::optional<bool> rumble_;
  std::optional<double> rumble_end_;  // while the motor runs
};

}  // namespace wiimote_tracker::driver
