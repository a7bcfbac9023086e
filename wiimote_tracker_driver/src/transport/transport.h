#pragma once

#include "transport/kernel_remotes.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <wiimote_tracker_msgs/error.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::transport {

/// A failure between host and remote; what() is one sentence that says what to do.
struct TransportError : Error {
  using Error::Error;
};
/// The text is no name of a device.
struct BadDeviceName : TransportError {
  using TransportError::TransportError;
};
struct NoSuchDevice : TransportError {
  using TransportError::TransportError;
};
struct PermissionDenied : TransportError {
  using TransportError::TransportError;
};
/// Another driver has the remote.
struct DeviceTaken : TransportError {
  using TransportError::TransportError;
};
/// The connection was lost.
struct Disconnected : TransportError {
  using TransportError::TransportError;
};

/// The other end of a connection.
struct Remote {
  std::string identity;     ///< Bluetooth address, lower case with colons; empty when not known.
  std::string description;  ///< Path for the user: "/dev/hidraw3", "virtual:/tmp/wiimote_1.sock".
  std::string kernel_driver = {};  ///< "wiimote", "hid-generic"; empty without one.
};

/// An open remote: HID reports out, HID reports in. Closed on destruction. Not thread-safe.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Waits up to `timeout` [s] for a report; 0: does not wait. @returns false without a report.
  /// @throws Disconnected.
  virtual bool read(protocol::Report& report, double timeout) = 0;

  /// @throws Disconnected.
  virtual void write(const protocol::Report& report) = 0;

  virtual Remote remote() const = 0;
};

/// A Bluetooth address such as 00:1F:32:12:34:56, in lower case; nothing when the text is none.
std::optional<std::string> bluetoothAddress(const std::string& text);

/// How a device is named: "" (the first free remote), a Bluetooth address, /dev/hidrawN,
/// virtual:SOCKET_PATH, or replay:FILE.
struct DeviceName {
  enum class Kind { kAny, kAddress, kPath, kVirtual, kReplay };
  Kind kind = Kind::kAny;
  std::string value;  ///< Address in lower case with colons, or path.
};

/// @throws BadDeviceName.
DeviceName parseDeviceName(const std::string& text);

/// Opens the remote for this process alone. A recording (kReplay) has a time of its own and is
/// opened by recording::Replay instead. @throws NoSuchDevice, PermissionDenied, DeviceTaken,
/// TransportError.
std::unique_ptr<Transport> open(const DeviceName& name);

/// `delivered`: whether images have come from the remote of the call before.
using Opener = std::function<std::unique_ptr<Transport>(bool delivered)>;

/// As open(), at each call. With kAny, the remote of the call before is the first to be tried if it
/// delivered images, so that the camera keeps its identity; else the last, since it did not work.
/// `list`: the kernel's remotes; for tests.
Opener opener(
    const DeviceName& name,
    std::function<std::vector<KernelRemote>()> list = [] { return kernelRemotes(); });

}  // namespace wiimote_tracker::transport
