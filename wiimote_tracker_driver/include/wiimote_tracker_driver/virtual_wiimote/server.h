#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/hosted_device.h"

#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// Makes a Device reachable at a local socket (AF_UNIX, SOCK_SEQPACKET, one report per packet), as
/// the kernel does at a hidraw node. A driver opens it as device "virtual:PATH". One host at a
/// time; the device keeps its state between hosts. The first packet to a host is the device's
/// identity as text. A second host gets "taken by process N", with the first one's process N, and
/// is disconnected. Owns one thread.
class Server : public HostedDevice {
 public:
  /// Listens at `path` and replaces a stale socket file. `identity` replaces the Bluetooth address
  /// ("00:1f:32:00:00:01").
  /// @throws std::system_error if the path cannot be used.
  Server(const std::string& path, const std::string& identity, const Device::Options& options);
  ~Server() override;

  /// Whether a host is connected.
  bool connected() const;

 private:
  void setReachable(bool reachable) override;
  void send(const std::vector<Bytes>& reports) override;

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote
