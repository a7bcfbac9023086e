#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_KERNEL_USE_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_KERNEL_USE_H

#include "checks.h"

namespace wiimote_tracker::real_kernel {

// Scenarios in which the kernel's own driver uses the remote while ours streams.
void battery(Checks& checks);
void evdev(Checks& checks);
void extension(Checks& checks);
void otherFormats(Checks& checks);
void leds(Checks& checks);
void rebind(Checks& checks);

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_KERNEL_USE_H
