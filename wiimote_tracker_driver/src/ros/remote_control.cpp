#include "remote_control.h"

namespace wiimote_tracker::driver {

RemoteControl::RemoteControl(std::uint8_t leds, double rumble_max)
    : rumble_max_(rumble_max), leds_(leds) {}

void RemoteControl::setSensitivity(const protocol::IrSensitivity& sensitivity) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sensitivity_ = sensitivity;
  changed_ = true;
}

void RemoteControl::setLeds(std::uint8_t leds, std::uint8_t mask) {
  const std::lock_guard<std::mutex> lock(mutex_);
  leds_ = static_cast<std::uint8_t>((leds_ & ~mask) | (leds & mask));
  leds_changed_ = true;
  changed_ = true;
}

void RemoteControl::setRumble(bool on) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rumble_ = on && rumble_max_ > 0.0;
  changed_ = true;
}

void RemoteControl::apply(wiimote::Wiimote& wiimote, double now) {
  if (!changed_.exchange(false) && !rumble_end_)
    return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (sensitivity_)
    wiimote.setSensitivity(*sensitivity_);
  sensitivity_.reset();
  if (leds_changed_)
    wiimote.setLeds(leds_);
  leds_changed_ = false;

  if (rumble_end_ && now >= *rumble_end_ && !rumble_)
    rumble_ = false;
  if (!rumble_)
    return;
  wiimote.setRumble(*rumble_);
  rumble_end_ = *rumble_ ? std::optional<double>(now + rumble_max_) : std::nullopt;
  rumble_.reset();
}

}  // namespace wiimote_tracker::driver
