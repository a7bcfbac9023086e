#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/hosted_device.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// Presents a Device to this machine's Linux kernel as a Bluetooth Wii Remote, through /dev/uhid:
/// the driver hid-wiimote binds it, and a hidraw node appears. Needs root and the kernel module
/// uhid. Owns one thread. setPresent(false) returns after the kernel has removed the device; after
/// setPresent(true) the kernel initialises it.
class UhidDevice : public HostedDevice {
 public:
  /// The values are the USB product ids.
  enum class Model : std::uint16_t {
    kRemote = 0x0306,  ///< RVL-CNT-01
    /// RVL-CNT-01-TR: refuses output on the control channel, has a built-in MotionPlus.
    kRemotePlus = 0x0330,
  };

  /// Called with each output report that reaches the device, in the device's thread. Must not throw
  /// or call the device.
  using Listener = std::function<void(const Bytes&)>;

  struct Options {
    Device::Options device;
    Model model = Model::kRemote;
    double latency = 0.0;  ///< From the host to the device [s, >= 0].
    Listener listener;
  };

  /// Plugs the remote in. `address` is its Bluetooth address ("00:1f:32:00:00:01") and should be
  /// unique: the kernel refuses a second battery of the same address.
  /// @throws std::system_error if /dev/uhid does not exist or may not be opened.
  UhidDevice(const std::string& address, const Options& options);
  ~UhidDevice() override;

 private:
  void setReachable(bool reachable) override;
  void send(const std::vector<Bytes>& reports) override;

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote
