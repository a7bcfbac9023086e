#ifndef WIIMOTE_TRACKER_DRIVER_TRANSPORT_HIDRAW_TRANSPORT_H
#define WIIMOTE_TRACKER_DRIVER_TRANSPORT_HIDRAW_TRANSPORT_H

#include "transport/transport.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::transport {

/// The file with the udev rule that lets users open remotes.
constexpr const char* kUdevRule = "60-wiimote-tracker.rules";

/// Opens a remote that the kernel offers as /dev/hidrawN, by its Bluetooth address, its path or
/// as the first free one, the one after `last` first. @throws as open().
std::unique_ptr<Transport> openHidraw(const DeviceName& name, const std::string& last);

/// Rotates devices so that the one with path `last`, if there is one, becomes the last.
template <typename Device>
void beginAfter(const std::string& last, std::vector<Device>* devices) {
  const auto at = std::find_if(devices->begin(), devices->end(),
                               [&](const Device& device) { return device.path == last; });
  if (at != devices->end())
    std::rotate(devices->begin(), at + 1, devices->end());
}

/// Throws the error, with its sentence, that belongs to a failed open(2) of a hidraw node.
[[noreturn]] void throwOpenError(int error_number, const std::string& path);

}  // namespace wiimote_tracker::transport

#endif  // WIIMOTE_TRACKER_DRIVER_TRANSPORT_HIDRAW_TRANSPORT_H
