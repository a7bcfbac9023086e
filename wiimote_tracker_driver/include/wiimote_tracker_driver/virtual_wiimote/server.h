#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_SERVER_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_SERVER_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <cstdint>
#include <memory>
#include <string>

namespace wiimote_tracker::virtual_wiimote {

/// Makes a Device reachable at a local socket (AF_UNIX, SOCK_SEQPACKET, one report a packet), as
/// the kernel makes a Wii Remote reachable at a hidraw node. One host at a time; a host may come
/// and go; the device keeps its state meanwhile. The first packet a host gets is the identity as
/// text; a second host gets "taken by process N" instead, N being the first, and is cut off. A
/// driver opens it as device "virtual:PATH".
/// Thread-safe; owns one thread.
class Server {
 public:
  /// Listens at `path` at once; a stale socket file is replaced. `identity` is what the host sees
  /// as the Bluetooth address ("00:1f:32:00:00:01").
  /// @throws std::system_error when the path cannot be used.
  Server(const std::string& path, const std::string& identity, const Device::Options& options);
  ~Server();

  /// Lets the device sense this instant and sends what results, if anything, to the host.
  /// @returns whether a data report was among it; not in the wrong mode, or while memory is read.
  /// @throws std::system_error as setPresent(), when a fault has the device come back.
  bool sample(const Senses& senses);

  /// What goes wrong from now on; at first nothing does.
  void setFaults(const Faults& faults);

  /// Plugs a Nunchuk into the remote, or pulls it out.
  void setNunchuk(bool plugged);

  /// The batteries' raw level from now on.
  void setBattery(std::uint8_t level);

  /// Whether a host is connected.
  bool connected() const;

  /// Player LEDs 1..4 in bits 0..3, as last set by a host.
  std::uint8_t leds() const;

  /// Whether the motor runs.
  bool rumble() const;

  /// Takes the device away (out of range) or brings it back power-cycled. While away, a connected
  /// host is cut off and nobody can connect.
  /// @throws std::system_error when the path cannot be used any more.
  void setPresent(bool present);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_SERVER_H
