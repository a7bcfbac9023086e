#pragma once

#include "transport/kernel_remotes.h"

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

struct BluetoothAdapter {
  enum class Block { kNone, kSoft, kHard };
  std::string name;  ///< "hci0"
  Block block = Block::kNone;
};

/// What is known about this computer without asking a service or opening a device.
struct Host {
  std::vector<transport::KernelRemote> remotes;
  std::vector<BluetoothAdapter> adapters;
  bool udev_rule = false;           ///< Some rule lets users open Wii Remotes.
  std::optional<bool> bonded_only;  ///< ClassicBondedOnly; nothing when not set.
};

/// `root`: prefix of /sys, /etc and /lib; for tests.
Host readHost(const std::string& root = "");

/// Problems of the computer, one sentence each with what to do.
std::vector<std::string> problems(const Host& host);

std::vector<std::string> problems(const transport::KernelRemote& remote);

/// What is good to know about the remote, one sentence each.
std::vector<std::string> notes(const transport::KernelRemote& remote);

/// "Wii Remote (RVL-CNT-01)", "Wii Remote Plus (RVL-CNT-01-TR)".
std::string modelOf(const transport::KernelRemote& remote);

}  // namespace wiimote_tracker::list_wiimotes
