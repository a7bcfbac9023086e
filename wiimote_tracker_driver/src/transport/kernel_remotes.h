#pragma once

#include <string>
#include <vector>

namespace wiimote_tracker::transport {

/// A Wii Remote known to the kernel, even if nobody can open it.
struct KernelRemote {
  std::string path;           ///< "/dev/hidraw3"; empty when the kernel made no node for it.
  std::string address;        ///< Lower case with colons; empty when not known.
  std::string adapter;        ///< Address of the Bluetooth adapter it is connected to, or empty.
  bool plus = false;          ///< The model RVL-CNT-01-TR, else RVL-CNT-01.
  std::string kernel_driver;  ///< "wiimote", "hid-generic"; empty when none is attached.
};

/// In the order in which device "" tries them and list_wiimotes numbers them: by the number of the
/// hidraw node. `root`: prefix of /sys; for tests.
std::vector<KernelRemote> kernelRemotes(const std::string& root = "");

}  // namespace wiimote_tracker::transport
