#pragma once

#include "checks.h"
#include "clock.h"
#include "plugged_remote.h"
#include "running_driver.h"

#include <stdexcept>
#include <string>

namespace wiimote_tracker::real_kernel {

/// Of the virtual remote with this number, 1 to 9.
inline std::string addressOf(int number) {
  return "00:1f:32:00:00:0" + std::to_string(number);
}
constexpr char kAddress[] = "00:1f:32:00:00:01";

// Time after the kernel's request for the battery without further reports: setup is complete [s].
constexpr double kSetUpTime = 1.0;
// Limit for waits that are no part of a recovery [s].
constexpr double kTimeout = 5.0;

/// A remote that the kernel has set up, and a driver that streams from it.
struct Streaming {
  explicit Streaming(Checks& checks, const wiimote::Options& options = {})
      : remote(kAddress, scene), driver(kAddress, scene, checks.images, options) {
    if (!driver.waitForState(wiimote::Link::State::kStreaming, kTimeout))
      throw std::runtime_error("the driver does not stream: " + driver.link().error);
    sleepFor(kSetUpTime);
  }

  Scene scene;
  PluggedRemote remote;
  RunningDriver driver;
};

}  // namespace wiimote_tracker::real_kernel
