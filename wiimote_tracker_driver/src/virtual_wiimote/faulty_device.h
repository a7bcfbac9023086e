#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTY_DEVICE_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTY_DEVICE_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <memory>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// A Device and the faults of its link. Pure logic; without faults it behaves like the device.
class FaultyDevice {
 public:
  explicit FaultyDevice(const Device::Options& options, const Faults& faults = Faults());
  ~FaultyDevice();

  /// Sets the faults; delayed reports still arrive.
  void setFaults(const Faults& faults);

  /// Handles an output report of the host. @returns the reports that reach the host, in order.
  std::vector<Bytes> handleOutput(const Bytes& report);

  /// Samples the sensors once. @returns the reports that reach the host now, in order.
  std::vector<Bytes> sample(const Senses& senses);

  /// As Device::setNunchuk. @returns the reports that reach the host.
  std::vector<Bytes> setNunchuk(bool plugged);

  /// As Device::powerCycle; delayed reports are lost.
  void powerCycle();

  /// Whether the remote is out of range because of Faults::unplug_every. Then it receives and sends
  /// nothing.
  bool away() const;

  /// Access without the link.
  Device& device();
  const Device& device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTY_DEVICE_H
