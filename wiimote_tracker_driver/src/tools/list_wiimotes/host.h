#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_HOST_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_HOST_H

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// A Wii Remote known to the kernel, even if nobody can open it.
struct KernelRemote {
  std::string path;           ///< "/dev/hidraw3"; empty when the kernel made no node for it.
  std::string address;        ///< Lower case with colons; empty when not known.
  std::string adapter;        ///< Address of the Bluetooth adapter it is connected to, or empty.
  bool plus = false;          ///< The model RVL-CNT-01-TR, else RVL-CNT-01.
  std::string kernel_driver;  ///< "wiimote", "hid-generic"; empty when none is attached.
};

struct BluetoothAdapter {
  enum class Block { kNone, kSoft, kHard };
  std::string name;  ///< "hci0"
  Block block = Block::kNone;
};

/// What is known about this computer without asking a service or opening a device.
struct Host {
  std::vector<KernelRemote> remotes;  ///< In the order of their paths.
  std::vector<BluetoothAdapter> adapters;
  bool udev_rule = false;           ///< Some rule lets users open Wii Remotes.
  std::optional<bool> bonded_only;  ///< ClassicBondedOnly; nothing when not set.
};

/// `root`: prefix of /sys, /etc and /lib; for tests.
Host readHost(const std::string& root = "");

/// Problems of the computer, one sentence each with what to do.
std::vector<std::string> problems(const Host& host);

std::vector<std::string> problems(const KernelRemote& remote);

/// "Wii Remote (RVL-CNT-01)", "Wii Remote Plus (RVL-CNT-01-TR)".
std::string modelOf(const KernelRemote& remote);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_HOST_H
