#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include "second_master.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// A Device and the faults of its link. Pure logic; without faults it behaves like the device.
class FaultyDevice {
 public:
  explicit FaultyDevice(const Device::Options& options, const Faults& faults = Faults());

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
  bool away() const { return away_; }

  /// Access without the link.
  Device& device() { return device_; }
  const Device& device() const { return device_; }

 private:
  struct DelayedReport {
    std::uint64_t due;  // [samples]
    Bytes report;
  };

  bool chance(double probability);
  std::size_t below(std::size_t limit) { return random_() % limit; }
  bool stalled() const { return samples_ < stall_end_; }
  void deliver(const Bytes& report);
  void send(Bytes report);
  void arrive(const Bytes& report);
  void releaseHeldBack();
  void releaseLate();
  Bytes garbage();
  void goAwayOrComeBack();

  Device device_;
  Faults faults_;
  std::mt19937 random_;
  std::optional<SecondMaster> second_master_;

  std::uint64_t samples_ = 0;
  std::uint64_t stall_end_ = 0;  // [samples]
  bool away_ = false;
  std::uint64_t came_or_went_ = 0;      // [samples]
  std::vector<DelayedReport> delayed_;  // late answers
  std::deque<Bytes> held_back_;         // by a stall
  std::vector<Bytes> arrived_;          // not yet handed to the host
};

}  // namespace wiimote_tracker::virtual_wiimote
