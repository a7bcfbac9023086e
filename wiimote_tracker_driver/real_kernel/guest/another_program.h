#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_ANOTHER_PROGRAM_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_ANOTHER_PROGRAM_H

#include "checks.h"

namespace wiimote_tracker::real_kernel {

/// Scenario: another program opens the same hidraw node, without asking for our lock, and writes to
/// the remote.
void anotherProgram(Checks& checks);

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_ANOTHER_PROGRAM_H
