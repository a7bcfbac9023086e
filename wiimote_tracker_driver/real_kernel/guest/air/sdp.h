#pragma once

#include "bytes.h"

#include <string>

namespace wiimote_tracker::real_kernel {

/// The answer of a Wii Remote to a request of the Service Discovery Protocol (Bluetooth Core,
/// Vol 3 Part B): it has a HID service and a PnP record with its product id.
/// @throws std::out_of_range if the request is too short.
Bytes answerSdp(const Bytes& request, const std::string& name, unsigned product);

}  // namespace wiimote_tracker::real_kernel
