#pragma once

#include <string>
#include <vector>

/// The kernel's view of a Wii Remote in its file systems.
namespace wiimote_tracker::real_kernel {

/// "/dev/hidraw0" of the remote with this Bluetooth address; empty when there is none.
std::string hidrawOf(const std::string& address);

/// The kernel's driver that is bound to it ("wiimote"); empty when there is none.
std::string kernelDriverOf(const std::string& address);

/// The kernel's name for it on the HID bus ("0005:057E:0306.0001").
std::string hidNameOf(const std::string& address);

/// Its folder in sysfs, which shows the path of its reports; empty when there is none.
std::string sysfsPathOf(const std::string& address);

/// The address of its Bluetooth adapter; empty when there is none.
std::string adapterOf(const std::string& address);

/// The file with its charge in percent, as a desktop reads it; empty when there is none.
std::string batteryFileOf(const std::string& address);

/// The file that switches its LED 1..4; empty when there is none.
std::string ledFileOf(const std::string& address, int led);

/// "/dev/input/event0" of its input device with this name; empty when there is none.
std::string inputNodeOf(const std::string& address, const std::string& name);

/// All nodes of input devices.
std::vector<std::string> inputNodes();

/// The first line of a file. @throws std::runtime_error when it cannot be read.
std::string readLine(const std::string& path);

/// @throws std::runtime_error when it cannot be written.
void writeText(const std::string& path, const std::string& text);

}  // namespace wiimote_tracker::real_kernel
