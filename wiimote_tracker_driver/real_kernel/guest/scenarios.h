#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_SCENARIOS_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_SCENARIOS_H

#include "checks.h"

#include <vector>

namespace wiimote_tracker::real_kernel {

/// Events on a Linux machine that affect a Wii Remote. Each scenario has a freshly booted kernel.
struct Scenario {
  const char* name;
  void (*run)(Checks& checks);
  const char* guest = "hid";  ///< What the kernel and the file system must have: see guests.py.
};

const std::vector<Scenario>& scenarios();

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_SCENARIOS_H
