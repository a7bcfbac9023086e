#pragma once

#include "transport/kernel_remotes.h"
#include "transport/transport.h"

#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::transport {

/// The file with the udev rule that lets users open remotes.
constexpr const char* kUdevRule = "60-wiimote-tracker.rules";

/// Opens one of the kernel's remotes: by its Bluetooth address, by its path or as the first free
/// one. @throws as open().
std::unique_ptr<Transport> openHidraw(const DeviceName& name, std::vector<KernelRemote> all);

/// Rotates remotes: the one with path `last`, if there is one, becomes the first if it has
/// delivered images, else the last.
void orderAfter(const std::string& last, bool delivered, std::vector<KernelRemote>* remotes);

/// Throws the error, with its sentence, that belongs to a failed open(2) of a hidraw node.
[[noreturn]] void throwOpenError(int error_number, const std::string& path);

}  // namespace wiimote_tracker::transport
