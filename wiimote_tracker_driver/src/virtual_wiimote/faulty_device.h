#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTY_DEVICE_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTY_DEVICE_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <memory>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// A Device and all that may go wrong between it and its host. Pure logic as the device; without
/// faults it is as if the host spoke to the device itself.
class FaultyDevice {
 public:
  explicit FaultyDevice(const Device::Options& options, const Faults& faults = Faults());
  ~FaultyDevice();

  /// From now on; what is held back already still comes.
  void setFaults(const Faults& faults);

  /// The host sent an output report. @returns what reaches the host by that, in order.
  std::vector<Bytes> handleOutput(const Bytes& report);

  /// One sensor instant. @returns what reaches the host now, in order.
  std::vector<Bytes> sample(const Senses& senses);

  /// As the device's; @returns what reaches the host by that.
  std::vector<Bytes> setNunchuk(bool plugged);

  /// As the device's; what was held back is lost.
  void powerCycle();

  /// Whether the remote is out of reach at present, as Faults::unplug_every has it. Then it hears
  /// and says nothing.
  bool away() const;

  /// For what no host takes part in.
  Device& device();
  const Device& device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTY_DEVICE_H
