#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_CLIENTS_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_CLIENTS_H

#include "checks.h"

namespace wiimote_tracker::real_kernel {

// The virtual remote is used by libraries that others wrote for real ones.

/// libxwiimote: through the kernel's driver and its input devices.
void xwiimoteClient(Checks& checks);

/// libcwiid: over L2CAP channels, without the kernel's driver.
void cwiidClient(Checks& checks);

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_CLIENTS_H
