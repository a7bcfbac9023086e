#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

class FaultyDevice;

/// A Device that hosts can reach. Thread-safe. Any function may throw std::system_error if a fault
/// brings the device back and it cannot be made reachable again.
class HostedDevice {
 public:
  HostedDevice(const HostedDevice&) = delete;
  HostedDevice& operator=(const HostedDevice&) = delete;

  /// Samples the device once and sends the resulting reports to the host. @returns whether they
  /// include a data report; there is none in other modes or while memory is read.
  bool sample(const Senses& senses);

  /// Sets the faults from now on; none at first.
  void setFaults(const Faults& faults);

  /// Plugs a Nunchuk in, or unplugs it.
  void setNunchuk(bool plugged);

  /// Sets the raw level of the batteries.
  void setBattery(std::uint8_t level);

  /// Player LEDs 1..4 in bits 0..3, as last set by a host.
  std::uint8_t leds() const;

  /// Whether the motor runs.
  bool rumble() const;

  /// Removes the device (out of range) or brings it back power-cycled. While it is away no host is
  /// connected. @throws std::system_error if it cannot be made reachable again.
  void setPresent(bool present);

 protected:
  HostedDevice(const Device::Options& options, bool present);
  virtual ~HostedDevice();

  /// Connects the device to its hosts, or disconnects it. Called with the mutex locked.
  virtual void setReachable(bool reachable) = 0;
  /// Sends reports to the host, if any. Called with the mutex locked.
  virtual void send(const std::vector<Bytes>& reports) = 0;

  mutable std::mutex mutex_;  ///< Guards the device and the connection.
  const std::unique_ptr<FaultyDevice> device_;

 private:
  bool present_;  ///< As set; a fault may still remove the device.
};

}  // namespace wiimote_tracker::virtual_wiimote
