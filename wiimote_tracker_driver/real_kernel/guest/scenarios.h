#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_SCENARIOS_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_SCENARIOS_H

#include "checks.h"

#include <vector>

namespace wiimote_tracker::real_kernel {

/// What may happen to a Wii Remote on a Linux machine. Each has a freshly booted kernel for itself.
struct Scenario {
  const char* name;
  void (*run)(Checks& checks);
};

const std::vector<Scenario>& scenarios();

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_SCENARIOS_H
