#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_MUTE_REMOTE_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_MUTE_REMOTE_H

#include "checks.h"

namespace wiimote_tracker::real_kernel {

/// A driver that may take any remote, and the first one does not answer.
void muteRemote(Checks& checks);

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_MUTE_REMOTE_H
