#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_STREAMING_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_STREAMING_H

#include "clock.h"
#include "plugged_remote.h"
#include "running_driver.h"

#include <stdexcept>
#include <string>

namespace wiimote_tracker::real_kernel {

constexpr char kAddress[] = "00:1f:32:00:00:01";
constexpr PluggedRemote::Light kLight{300.0, 200.0, 3.0, 1.0};

// The kernel has set a remote up when it has asked for the battery and nothing more comes [s].
constexpr double kSetUpTime = 1.0;
// For what takes its time but is no part of a recovery [s].
constexpr double kPatience = 5.0;

/// A remote, the kernel done with it, and a driver that streams from it.
struct Streaming {
  explicit Streaming(const std::string& address = kAddress,
                     const PluggedRemote::Light& light = kLight,
                     PluggedRemote::Model model = PluggedRemote::Model::kRemote,
                     const wiimote::SessionOptions& options = {})
      : remote(address, light, model), driver(address, light, options) {
    if (!driver.waitForState(wiimote::Link::State::kStreaming, kPatience))
      throw std::runtime_error("the driver does not stream: " + driver.link().error);
    sleepFor(kSetUpTime);
  }

  PluggedRemote remote;
  RunningDriver driver;
};

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_STREAMING_H
