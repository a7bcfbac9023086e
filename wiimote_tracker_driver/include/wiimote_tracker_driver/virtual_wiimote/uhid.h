#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_UHID_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_UHID_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace wiimote_tracker::virtual_wiimote {

/// Makes a Device a Bluetooth Wii Remote of this machine's Linux kernel, through /dev/uhid: its
/// driver hid-wiimote binds it, and a hidraw node appears for everybody to open. Needs root and the
/// kernel module uhid. Thread-safe; owns one thread.
class UhidDevice {
 public:
  /// The values are the USB product ids.
  enum class Model : std::uint16_t {
    kRemote = 0x0306,  ///< RVL-CNT-01
    /// RVL-CNT-01-TR; refuses output on the control channel, has a MotionPlus built in.
    kRemotePlus = 0x0330,
  };

  /// Hears each output report as it reaches the device; called in the device's own thread, and must
  /// not call the device.
  using Listener = std::function<void(const Bytes&)>;

  struct Options {
    Device::Options device;
    Model model = Model::kRemote;
    double latency = 0.0;  ///< [s, >= 0] An output report is so long under way, as over the air.
    Listener listener;
  };

  /// Plugs the remote in at once. `address` is its Bluetooth address ("00:1f:32:00:00:01") and
  /// should be its own: the kernel refuses a second battery of the same address.
  /// @throws std::system_error when there is no /dev/uhid or it may not be opened.
  UhidDevice(const std::string& address, const Options& options);
  ~UhidDevice();

  /// Lets the device sense this instant and sends what results, if anything, to the kernel.
  /// @throws std::system_error when a fault has the device go or come back and the kernel refuses.
  void sample(const Senses& senses);

  /// What goes wrong from now on; at first nothing does.
  void setFaults(const Faults& faults);

  /// Plugs a Nunchuk into the remote, or pulls it out.
  void setNunchuk(bool plugged);

  /// The batteries' raw level from now on.
  void setBattery(std::uint8_t level);

  /// Player LEDs 1..4 in bits 0..3, as last set by a host or by the kernel.
  std::uint8_t leds() const;

  /// Whether the motor runs.
  bool rumble() const;

  /// Takes the device away (out of range) or brings it back power-cycled. Returns when the kernel
  /// has let go of it; a device that comes back is set up by the kernel afterwards.
  /// @throws std::system_error when the kernel refuses.
  void setPresent(bool present);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_UHID_H
