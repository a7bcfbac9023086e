#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_BLUETOOTH_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_BLUETOOTH_H

#include "checks.h"

/// Scenarios with remotes in the air, the kernel's Bluetooth, and BlueZ.
namespace wiimote_tracker::real_kernel {

void pairScenario(Checks& checks);
void pairRefused(Checks& checks);
void twoAdapters(Checks& checks);
void overHidp(Checks& checks);
void overUserspaceHid(Checks& checks);

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_BLUETOOTH_H
